#pragma once

#include <tendril/base/types.h>

/// Signs by numbers of any length, for any finite doubles. The only door to CGAL, whose number type is used
/// and nothing that would change the rounding mode. About a microsecond for ordinary numbers.
namespace tendril::exact::fallback {

int side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x);
int turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c);
int compare_distance(Points a, Points b, double radius_a, double radius_b);

struct Bounds {
  double lower, upper;
};
/// The distance of disjoint simplices, to 2^-50 of it, or as near as denormal and infinite numbers allow.
Bounds distance(Points a, Points b);

}  // namespace tendril::exact::fallback
