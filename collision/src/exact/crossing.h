#pragma once

#include <tendril/exact/shape.h>

#include "exact/predicates.h"

/// Relations of points, segments and triangles, of radius 0. All ask for proper shapes: ends that differ,
/// corners not on one line.
namespace tendril::exact {

/// The points of a shape, one to three.
inline Points points_of(const Shape& shape) {
  const bool two = shape.kind == Kind::segment || shape.kind == Kind::capsule;
  return Points(shape.points).first(shape.kind == Kind::triangle ? 3 : two ? 2 : 1);
}

/// The same set by as few points as it needs: a triangle on a line is a segment or a point, a capsule of no
/// length a ball.
Shape reduced(const Predicates& signs, const Shape& shape);

Relation point_point(const Predicates& signs, const Shape& a, const Shape& b);
Relation point_segment(const Predicates& signs, const Shape& a, const Shape& b);
Relation point_triangle(const Predicates& signs, const Shape& a, const Shape& b);
Relation segment_segment(const Predicates& signs, const Shape& a, const Shape& b);
Relation segment_triangle(const Predicates& signs, const Shape& a, const Shape& b);
Relation triangle_triangle(const Predicates& signs, const Shape& a, const Shape& b);

/// Two triangles, proper or not [Guigue and Devillers 2003], undecidable where all corners of one lie in the
/// plane of the other, as those of any do in the plane of an improper one.
Relation across(const Predicates& signs, const Triangle& a, const Triangle& b);

/// The corners' sides of the others' plane, and what they say.
struct Sides {
  int of[3];
  bool apart() const { return of[0] != 0 && of[0] == of[1] && of[1] == of[2]; }
  bool flat() const { return of[0] == 0 && of[1] == 0 && of[2] == 0; }
  bool both() const { return has(1) && has(-1); }
  bool has(int side) const { return of[0] == side || of[1] == side || of[2] == side; }
};

}  // namespace tendril::exact
