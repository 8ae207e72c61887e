#pragma once

#include "sweep.h"

/// Places of the axes that points are bound to besides their nearest projection. They are fixed and few, and
/// the points that take part in them many: a pose moves the space around each place once, rigidly, and a
/// point takes the weighted mean of these maps.
namespace tendril::bind {

/// A place of the axes and its frame at rest.
struct AxisNode {
  std::uint32_t pair, span;
  double t, s;  ///< parameter, and as the span's polynomials take it
  Vec3 origin;  ///< at rest, from BindingLayout::rest_base
  Mat3 frame;   ///< at rest, with the columns l_x, l_y, l_z
};

/// Four numbers, computed with in one operation.
template <class T>
using Row __attribute__((vector_size(4 * sizeof(T)), aligned(alignof(T)), may_alias)) = T;

/// p to A p + b, in rows (A, b).
template <class T>
struct AffineMap {
  T row[3][4];

  /// By reference: how vectors are returned depends on the vector unit.
  TENDRIL_INLINE const Row<T>& vector(std::size_t i) const {
    return *reinterpret_cast<const Row<T>*>(row[i]);
  }
  TENDRIL_INLINE Row<T>& vector(std::size_t i) { return *reinterpret_cast<Row<T>*>(row[i]); }
};

/// A point of a curve-pair and its frame, or the rates of both.
struct FrameColumns {
  Triple<double> origin, x, y, z;
};

/// The frame turned; or the rates of one, the turn held.
inline void turn_columns(const Turn& by, FrameColumns& at) {
  const Triple<double> x = by.cosine * at.x + by.sine * at.y;
  at.y = by.cosine * at.y - by.sine * at.x;
  at.x = x;
}

/// What takes a point, from rest_base, from where it is in a node's frame at rest to where it is in another.
template <class T>
AffineMap<T> map_between(const AxisNode& node, const FrameColumns& to);

/// From rest_base to a pose's base.
template <class T>
AffineMap<T> map_of(const AxisNode& node, const Piece<double>& piece, const CurvePair& posed,
                    const Vec3& base);

/// A point's shares in nodes.
template <class T>
struct NodeShares {
  const std::uint32_t* node;
  const T* share;
  std::size_t count;
};

/// base + sum_k share_k (map_k(place) - base), summed as one map. At rest the sum vanishes up to rounding,
/// whatever the shares add up to. The order of operations is the same on every vector unit.
/// \param map_of  of a node
/// \param place   of the point at rest, from rest_base
/// \param base    where its nearest projection takes it, from the pose's base
template <class T, class MapOf>
TENDRIL_INLINE Triple<T> mix(const NodeShares<T>& shares, const MapOf& map_of, const Triple<T>& place,
                             const Triple<T>& base) {
  Row<T> x = {}, y = {}, z = {};
  T whole = T(0);
  for (std::size_t k = 0; k < shares.count; ++k) {
    const AffineMap<T>& map = map_of(shares.node[k]);
    const T share = shares.share[k];
    x += share * map.vector(0);
    y += share * map.vector(1);
    z += share * map.vector(2);
    whole += share;
  }
  const Triple<T> to{x[0] * place.x + x[1] * place.y + x[2] * place.z + x[3],
                     y[0] * place.x + y[1] * place.y + y[2] * place.z + y[3],
                     z[0] * place.x + z[1] * place.y + z[2] * place.z + z[3]};
  return base + (to - whole * base);
}

}  // namespace tendril::bind
