#include "exact/crossing.h"

namespace tendril::exact {

namespace {

Sides sides(const Predicates& signs, const Triangle& of, const Triangle& plane) {
  const Plane p(signs, plane[0], plane[1], plane[2]);
  return {p.side(of[0]), p.side(of[1]), p.side(of[2])};
}

/// The corner that a plane parts from the two others, and the side that it is on, or is taken to be on where
/// it lies in the plane and both others are on one side.
struct Lone {
  std::size_t corner;
  int side;
};
Lone lone(const Sides& s) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int here = s.of[i], b = s.of[(i + 1) % 3], c = s.of[(i + 2) % 3];
    if (here != 0 && here * b <= 0 && here * c <= 0) return {i, here};
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (s.of[i] == 0) return {i, -s.of[(i + 1) % 3]};
  return {2, -s.of[0]};
}

}  // namespace

Relation across(const Predicates& signs, const Triangle& a, const Triangle& b) {
  const Sides of_a = sides(signs, a, b);
  if (of_a.apart()) return Relation::free;
  const Sides of_b = sides(signs, b, a);
  if (of_b.apart()) return Relation::free;
  if (of_a.flat() || of_b.flat()) return Relation::undecidable;

  // Turned so that the lone corners p come first, and seen so that each is above the other's plane.
  const Lone in_a = lone(of_a), in_b = lone(of_b);
  const auto corner = [](const Triangle& t, const Lone& l, std::size_t i) -> const Vec3& {
    return t[(l.corner + i) % 3];
  };
  const Vec3 &p1 = corner(a, in_a, 0), &p2 = corner(b, in_b, 0);
  const Vec3 &q1 = corner(a, in_a, in_b.side > 0 ? 1 : 2), &r1 = corner(a, in_a, in_b.side > 0 ? 2 : 1);
  const Vec3 &q2 = corner(b, in_b, in_a.side > 0 ? 1 : 2), &r2 = corner(b, in_b, in_a.side > 0 ? 2 : 1);

  // Each interval must begin before the other ends.
  const int first = signs.side(p1, q1, p2, q2);
  if (first > 0) return Relation::free;
  const int second = signs.side(p1, r1, r2, p2);
  if (second > 0) return Relation::free;
  return first < 0 && second < 0 && of_a.both() && of_b.both() ? Relation::hit : Relation::touching;
}

}  // namespace tendril::exact
