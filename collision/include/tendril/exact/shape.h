#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>
#include <tendril/collision/answer.h>

#include <array>

/// Exact relations of small convex shapes, on the very doubles given: no tolerance, no case left out, the
/// same answer in every rounding mode, with the host's mode left as found.
namespace tendril::exact {

using collision::Answer;
using collision::Reason;
using collision::Relation;

/// From one end to the other.
using Segment = std::array<Vec3, 2>;
/// Corners, in any order.
using Triangle = std::array<Vec3, 3>;

/// What a shape is.
enum class Kind {
  point,     ///< one point
  segment,   ///< the hull of two
  triangle,  ///< the hull of three
  ball,      ///< all within the radius of a point
  capsule    ///< all within the radius of a segment
};

/// A closed set: the convex hull of one, two or three points, for balls and capsules widened by a radius. The
/// points may coincide or lie on one line: then it is the smaller set that they span.
struct Shape {
  Kind kind;            ///< says how many points count
  Triangle points;      ///< those that the kind does not use repeat the first
  double radius = 0.0;  ///< [length] 0 or more; 0 but for balls and capsules
};

/// A point.
inline Shape point(const Vec3& x) {
  return {Kind::point, {x, x, x}};
}
/// A segment.
inline Shape segment(const Segment& s) {
  return {Kind::segment, {s[0], s[1], s[0]}};
}
/// A triangle.
inline Shape triangle(const Triangle& t) {
  return {Kind::triangle, t};
}
/// A solid ball.
inline Shape ball(const Vec3& centre, double radius) {
  return {Kind::ball, {centre, centre, centre}, radius};
}
/// A solid capsule.
inline Shape capsule(const Segment& s, double radius) {
  return {Kind::capsule, {s[0], s[1], s[0]}, radius};
}

/// How two shapes lie to each other: free, touching or hit, as Relation defines them. Undecidable only for
/// numbers that are not finite and negative radii. Any finite numbers will do, the largest and denormal ones
/// too, which cost more.
///
/// Static filters in doubles first [Shewchuk 1997], then integers of 192 bits, then numbers of any length;
/// two triangles by [Guigue and Devillers 2003]. Radii are compared as squares, exactly: no root is taken.
TENDRIL_EXACT_API Answer relation(const Shape& a, const Shape& b);

/// The same of two triangles, without the detour over shapes.
TENDRIL_EXACT_API Answer relation(const Triangle& a, const Triangle& b);

}  // namespace tendril::exact
