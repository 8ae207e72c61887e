#pragma once

#include <tendril/base/types.h>

#include <array>
#include <cstddef>
#include <span>

namespace tendril {

/// Up to 128 edges in the air, number by number: the vectors along them, the means of their ends' velocities,
/// their widths, when the air passes their middles, and its velocity there over that of the mean wind.
struct ExposedEdges {
  static constexpr std::size_t kMost = 128;
  using Numbers = std::array<double, kMost>;
  Numbers x, y, z, vx, vy, vz, width, delay, air;
};

/// What the air does to them: coefficients of flow across and along an edge, over length and width, with the
/// factor -rho / 4 of one end.
struct DragPerLength {
  Vec3 mean;  ///< wind
  double normal, tangential;
};

/// Takes the edges between each of some nodes and the next one. Their delays are the products of `by` with
/// their middles.
/// \param p, v   places and velocities, one more than there are edges
/// \param width  per edge
void expose(std::span<const Vec3> p, std::span<const Vec3> v, std::span<const double> width, const Vec3& by,
            ExposedEdges& edges);

/// The drag of half of each edge, into x, y and z: with e the unit vector, l the length and w the flow past
/// the edge, l width (c_n |w_n| w_n + c_t |w_t| w_t). 0 for an edge without a length or a width.
void drag(const DragPerLength& by, std::size_t count, ExposedEdges& edges);

/// Adds that to the forces on both nodes of each edge.
/// \param force  one more than there are edges
void put_drag(const ExposedEdges& edges, std::span<Vec3> force);

}  // namespace tendril
