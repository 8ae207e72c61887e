#include "exact/narrow.h"

#include <algorithm>
#include <utility>

#include "exact/crossing.h"
#include "exact/fallback.h"
#include "exact/polynomials.h"

namespace tendril::exact {

namespace {

using Test = Relation (*)(const Predicates&, const Shape&, const Shape&);

template <Test test>
Relation swapped(const Predicates& signs, const Shape& a, const Shape& b) {
  return test(signs, b, a);
}

/// With a radius: as far apart as the radii together, or nearer.
Relation rounded(const Predicates& signs, const Shape& a, const Shape& b);

/// The narrow phase: a kind of shape is a row and a column, for proper shapes.
constexpr Test kTests[5][5] = {
    // point                  segment                    triangle           ball     capsule
    {point_point, point_segment, point_triangle, rounded, rounded},                             // point
    {swapped<point_segment>, segment_segment, segment_triangle, rounded, rounded},              // segment
    {swapped<point_triangle>, swapped<segment_triangle>, triangle_triangle, rounded, rounded},  // triangle
    {rounded, rounded, rounded, rounded, rounded},                                              // ball
    {rounded, rounded, rounded, rounded, rounded},                                              // capsule
};

Relation look_up(const Predicates& signs, const Shape& a, const Shape& b) {
  return kTests[static_cast<int>(a.kind)][static_cast<int>(b.kind)](signs, a, b);
}

Shape core(const Shape& s) {
  const bool ball = s.kind == Kind::ball, capsule = s.kind == Kind::capsule;
  return {ball ? Kind::point : capsule ? Kind::segment : s.kind, s.points};
}

Relation rounded(const Predicates& signs, const Shape& a, const Shape& b) {
  const Relation cores = look_up(signs, core(a), core(b));
  if (compare(a.radius, 0.0) == 0 && compare(b.radius, 0.0) == 0) return cores;
  if (cores != Relation::free) return Relation::hit;
  const Points p = points_of(a), q = points_of(b);
  int order = signs.ordinary() ? compare_distance<Bounded>(p, q, a.radius, b.radius) : kUnknown;
  if (order == kUnknown) order = fallback::compare_distance(p, q, a.radius, b.radius);
  return order < 0 ? Relation::hit : order == 0 ? Relation::touching : Relation::free;
}

}  // namespace

Range range_of(const Shape& s) {
  const Range radius = range_of(s.radius);
  if (compare(s.radius, 0.0) < 0) return Range::not_finite;
  return std::max(radius, range_of({Points(s.points)}));
}

Relation relation(Range range, const Shape& a, const Shape& b) {
  const Predicates signs(range);
  return look_up(signs, reduced(signs, a), reduced(signs, b));
}

Relation relation(Range range, const Triangle& a, const Triangle& b) {
  const Relation r = across(Predicates(range), a, b);
  return r == Relation::undecidable ? relation(range, triangle(a), triangle(b)) : r;
}

Answer relation(const Shape& a, const Shape& b) {
  const Range range = std::max(range_of(a), range_of(b));
  if (range == Range::not_finite) return undecidable(Reason::not_finite);
  return {relation(range, a, b)};
}

Answer relation(const Triangle& a, const Triangle& b) {
  const Range range = range_of({Points(a), Points(b)});
  if (range == Range::not_finite) return undecidable(Reason::not_finite);
  return {relation(range, a, b)};
}

}  // namespace tendril::exact
