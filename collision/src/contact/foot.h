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
/// From the second of these points to the first.
inline Vec3 apart(const SegmentFeet& feet, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return a + feet.s * (b - a) - c - feet.t * (d - c);
}

/// A point is within `far` of the box about a triangle: what spares most pairs the rest.
inline bool beside(const Vec3& x, const std::array<Vec3, 3>& t, double far) {
  const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  return (low.array() - far <= x.array()).all() && (x.array() <= high.array() + far).all();
}
/// The boxes about two segments are within `far` of each other.
inline bool beside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double far) {
  return (a.cwiseMin(b).array() - far <= c.cwiseMax(d).array()).all() &&
         (c.cwiseMin(d).array() <= a.cwiseMax(b).array() + far).all();
}

}  // namespace tendril::contact
