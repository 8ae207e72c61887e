#include "exact/crossing.h"

#include <algorithm>
#include <utility>

namespace tendril::exact {

namespace {

Relation touching_if(bool meet) {
  return meet ? Relation::touching : Relation::free;
}

/// An axis along which a, b, c do not look like a line; 3 where they lie on one.
int axis_of(const Predicates& signs, const Vec3& a, const Vec3& b, const Vec3& c) {
  int axis = 0;
  while (axis < 3 && signs.turn(axis, a, b, c) == 0) ++axis;
  return axis;
}

bool on_one_line(const Predicates& signs, const Vec3& a, const Vec3& b, const Vec3& c) {
  return axis_of(signs, a, b, c) == 3;
}

/// Ends of a segment in the order of compare().
std::pair<Vec3, Vec3> in_order(Points s) {
  return compare(s[0], s[1]) <= 0 ? std::pair(s[0], s[1]) : std::pair(s[1], s[0]);
}

/// Segments or points on one line.
bool overlap_on_line(Points a, Points b) {
  const auto [a_low, a_high] = in_order(a);
  const auto [b_low, b_high] = in_order(b);
  return compare(a_low, b_high) <= 0 && compare(b_low, a_high) <= 0;
}

/// Seen along the axis, some edge of a has all of a on one side and all of b strictly on the other; a
/// segment's line has a on neither.
bool an_edge_parts(const Predicates& signs, int axis, Points a, Points b) {
  const std::size_t edges = a.size() == 3 ? 3 : a.size() - 1;
  for (std::size_t i = 0; i < edges; ++i) {
    const Vec3 &from = a[i], &to = a[(i + 1) % a.size()];
    const int own = a.size() == 3 ? signs.turn(axis, from, to, a[(i + 2) % 3]) : 0;
    const int side = signs.turn(axis, from, to, b[0]);
    if (side == 0 || side == own) continue;
    if (std::all_of(b.begin(), b.end(), [&](const Vec3& x) { return signs.turn(axis, from, to, x) == side; }))
      return true;
  }
  return false;
}

/// In one plane, which looks like a plane along the axis: convex polygons are apart where an edge's line
/// parts them. Sets in a plane never hit.
Relation in_plane(const Predicates& signs, int axis, Points a, Points b) {
  return touching_if(!an_edge_parts(signs, axis, a, b) && !an_edge_parts(signs, axis, b, a));
}

Relation in_plane_of(const Predicates& signs, const Triangle& t, Points other) {
  return in_plane(signs, axis_of(signs, t[0], t[1], t[2]), t, other);
}

}  // namespace

Shape reduced(const Predicates& signs, const Shape& shape) {
  Shape out = shape;
  auto& [a, b, c] = out.points;
  if (out.kind == Kind::triangle && on_one_line(signs, a, b, c)) {
    std::sort(out.points.begin(), out.points.end(),
              [](const Vec3& x, const Vec3& y) { return compare(x, y) < 0; });
    std::swap(b, c);
    out.kind = Kind::segment;
  }
  const bool point = compare(a, b) == 0;
  if (out.kind == Kind::segment && point) out.kind = Kind::point;
  if (out.kind == Kind::capsule && point) out.kind = Kind::ball;
  return out;
}

Relation point_point(const Predicates&, const Shape& a, const Shape& b) {
  return touching_if(compare(a.points[0], b.points[0]) == 0);
}

Relation point_segment(const Predicates& signs, const Shape& a, const Shape& b) {
  return touching_if(on_one_line(signs, b.points[0], b.points[1], a.points[0]) &&
                     overlap_on_line(std::array{a.points[0], a.points[0]}, points_of(b)));
}

Relation point_triangle(const Predicates& signs, const Shape& a, const Shape& b) {
  const Triangle& t = b.points;
  if (signs.side(t[0], t[1], t[2], a.points[0]) != 0) return Relation::free;
  return in_plane_of(signs, t, points_of(a));
}

Relation segment_segment(const Predicates& signs, const Shape& a, const Shape& b) {
  const auto& [p, q, p_again] = a.points;
  const auto& [r, s, r_again] = b.points;
  if (signs.side(p, q, r, s) != 0) return Relation::free;
  const int axis = std::min(axis_of(signs, p, q, r), axis_of(signs, p, q, s));
  if (axis == 3) return touching_if(overlap_on_line(points_of(a), points_of(b)));
  return in_plane(signs, axis, points_of(a), points_of(b));
}

/// Where the ends are not on one side, the segment's line passes the triangle's edges all on the same side or
/// meets them.
Relation segment_triangle(const Predicates& signs, const Shape& a, const Shape& b) {
  const auto& [p, q, p_again] = a.points;
  const Triangle& t = b.points;
  const Plane plane(signs, t[0], t[1], t[2]);
  const int at_p = plane.side(p), at_q = plane.side(q);
  if (at_p == at_q) return at_p == 0 ? in_plane_of(signs, t, points_of(a)) : Relation::free;
  const Sides s{signs.side(p, q, t[0], t[1]), signs.side(p, q, t[1], t[2]), signs.side(p, q, t[2], t[0])};
  if (s.both()) return Relation::free;
  return s.has(0) || at_p * at_q == 0 ? Relation::touching : Relation::hit;
}

Relation triangle_triangle(const Predicates& signs, const Shape& a, const Shape& b) {
  const Relation r = across(signs, a.points, b.points);
  return r == Relation::undecidable ? in_plane_of(signs, a.points, b.points) : r;
}

}  // namespace tendril::exact
