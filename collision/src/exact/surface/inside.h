#pragma once

#include <tendril/collision/box_tree.h>
#include <tendril/exact/surface.h>

#include <cstdint>
#include <vector>

#include "exact/predicates.h"

namespace tendril::exact {

/// Of each pair of different corners: whether it is an edge of an even number of triangles, and of as many
/// one way round as the other.
Closure closure_of(std::span<const std::uint32_t> corners);

/// Crossings of a ray from a point that is on no triangle: all, and those that leave less those that enter.
struct Crossings {
  int all = 0, winding = 0;
  void add(int crossing) {
    all += crossing != 0;
    winding += crossing;
  }
  bool inside(Closure closure) const { return closure == Closure::oriented ? winding != 0 : all % 2 != 0; }
};

/// The corners with the first of all points at the same place in each one's stead.
std::vector<std::uint32_t> with_coincident_as_one(Points points, std::span<const std::uint32_t> corners);

/// Boxes that a ray from the point along z may meet, or that hold the point.
inline bool above_or_in(const collision::Box& box, const Vec3& x) {
  return box.low.x() <= x.x() && x.x() <= box.high.x() && box.low.y() <= x.y() && x.y() <= box.high.y() &&
         x.z() <= box.high.z();
}

/// 1 where the ray from x along z leaves through the triangle's front, -1 where it enters there, 0 where it
/// passes by; for x not on the triangle. x counts as moved by (e, e^2, 0) with e > 0 less than any number, so
/// that no ray meets an edge.
int crossing_above(const Predicates& signs, const Triangle& t, const Vec3& x);

/// What the triangle covers of the sphere about x, of 4 pi, rounded [van Oosterom and Strackee 1983];
/// positive where x sees its back.
double solid_angle(const Triangle& t, const Vec3& x);

}  // namespace tendril::exact
