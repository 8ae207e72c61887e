#pragma once

#include <tendril/base/types.h>

#include <array>

namespace tendril::contact {

/// The nearest point of a triangle. Edge i goes from corner i to the next.
struct Foot {
  /// Of the three corners, edges and the face, which is nearest.
  enum class Part { corner, edge, face };
  Vec3 point;
  Part part;
  std::size_t which;
  std::array<double, 3> share;  ///< of the corners; exactly 0 of those that have no part
};

/// After [Ericson 2005] 5.1.5: by the signs of products that say beside which part x stands.
Foot foot_on(const std::array<Vec3, 3>& triangle, const Vec3& x);

/// The nearest points of two segments a + s (b - a) and c + t (d - c).
struct SegmentFeet {
  double s, t;
};
/// One of two that are as near where the segments are parallel.
SegmentFeet feet_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace tendril::contact
