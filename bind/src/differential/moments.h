#pragma once

#include "place/axis_nodes.h"

namespace tendril::bind {

/// Forces on the coefficients of a span's polynomials, c_j and the scaled d_j.
struct Moments {
  std::array<std::array<double, 3>, kMostTerms> c{}, d{};

  Moments& operator+=(const Moments& other);
};

inline constexpr std::size_t kMomentChunk = 256;

/// Sums over forces f with places q at rest, from rest_base, of share f q^T and, in the last column, share
/// f: what they do to a node's map.
using MapForces = AffineMap<double>;

/// Adds what forces on the map of a node do to its span's polynomials.
void add_moments(const AxisNode& node, const Piece<double>& piece, const MapForces& forces, Moments& to);

/// Adds what forces on points of a span do to its polynomials: the transpose of evaluate() by c_j and d_j,
/// the records fixed. Where there is no frame the point is taken to follow the curve alone. The sum has one
/// order, eight lanes added up in the end, on every vector unit.
/// \param count  at most kMomentChunk
void add_moments(const Piece<double>& piece, const RecordsView<double>& records,
                 const ColumnsView<const double>& force, std::size_t count, Moments& to);
void add_moments_on(VectorUnit unit, const Piece<double>& piece, const RecordsView<double>& records,
                    const ColumnsView<const double>& force, std::size_t count, Moments& to);

}  // namespace tendril::bind
