#include <tendril/exact/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/crossing.h"
#include "exact/fallback.h"
#include "exact/narrow.h"
#include "exact/polynomials.h"

namespace tendril::exact {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// first + s (second - first) + t (third - first), with s, t >= 0 and s + t <= 1.
struct Place {
  const Vec3 *first, *second, *third;
  double s = 0.0, t = 0.0;

  Vec3 value() const { return *first + s * (*second - *first) + t * (*third - *first); }
};

/// No number so small that a product with it could underflow.
double weight(double s, double most) {
  return s < 0x1p-100 ? 0.0 : std::min(s, most);
}
Place at_corner(const Vec3& x) {
  return {&x, &x, &x};
}
Place on_edge(const Vec3& a, const Vec3& b, double s) {
  return {&a, &b, &a, weight(s, 1.0), 0.0};
}
/// 1 - s may be rounded up by 2^-53.
Place on_face(Points p, double s, double t) {
  return {&p[0], &p[1], &p[2], weight(s, 1.0), weight(t, (1.0 - s) * (1.0 - 2 * kEps))};
}

struct Candidate {
  Place on_a, on_b;
  double square = kInfinity;
};

/// Nearest places of two simplices by rounded arithmetic, perhaps not the nearest: what they are worth is
/// proven after.
class Search {
 public:
  Search(Points a, Points b) : a_(a), b_(b), best_{at_corner(a[0]), at_corner(b[0])} {
    for (const Vec3& x : a)
      for (const Vec3& y : b) offer(at_corner(x), at_corner(y));
    for (const bool swap : {false, true}) corners_to_edges_and_face(swap);
    for (std::size_t i = 0; i < edges(a); ++i)
      for (std::size_t j = 0; j < edges(b); ++j) edge_to_edge(a[i], next(a, i), b[j], next(b, j));
  }
  const Candidate& best() const { return best_; }

 private:
  static std::size_t edges(Points p) { return p.size() == 3 ? 3 : p.size() - 1; }
  static const Vec3& next(Points p, std::size_t i) { return p[(i + 1) % p.size()]; }

  void offer(const Place& on_a, const Place& on_b) {
    const double square = (on_a.value() - on_b.value()).squaredNorm();
    if (square < best_.square) best_ = {on_a, on_b, square};
  }
  void offer(bool swap, const Place& x, const Place& y) { swap ? offer(y, x) : offer(x, y); }

  void corners_to_edges_and_face(bool swap) {
    const Points p = swap ? b_ : a_, q = swap ? a_ : b_;
    for (const Vec3& x : p) {
      for (std::size_t i = 0; i < edges(q); ++i) {
        const Vec3 d = next(q, i) - q[i];
        offer(swap, at_corner(x), on_edge(q[i], next(q, i), (x - q[i]).dot(d) / d.squaredNorm()));
      }
      if (q.size() == 3) corner_to_face(swap, x, q);
    }
  }

  void corner_to_face(bool swap, const Vec3& x, Points q) {
    const Vec3 w = x - q[0], u = q[1] - q[0], v = q[2] - q[0], n = u.cross(v);
    const double s = w.cross(v).dot(n) / n.squaredNorm(), t = u.cross(w).dot(n) / n.squaredNorm();
    if (s >= 0 && t >= 0 && s + t <= 1) offer(swap, at_corner(x), on_face(q, s, t));
  }

  void edge_to_edge(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
    const Vec3 d = b - a, e = q - p, c = d.cross(e);
    const double s = (p - a).cross(e).dot(c) / c.squaredNorm(), t = (p - a).cross(d).dot(c) / c.squaredNorm();
    if (s > 0 && s < 1 && t > 0 && t < 1) offer(on_edge(a, b, s), on_edge(p, q, t));
  }

  Points a_, b_;
  Candidate best_;
};

/// x - y with all roundings counted.
Vector<Bounded> apart(const Place& x, const Place& y) {
  Vector<Bounded> w = difference<Bounded>(*x.first, *y.first);
  const auto add = [&w](double weight, const Vec3& to, const Vec3& from) {
    const Vector<Bounded> d = difference<Bounded>(to, from);
    for (std::size_t k = 0; k < 3; ++k) w[k] = w[k] + Bounded(weight) * d[k];
  };
  add(x.s, *x.second, *x.first);
  add(x.t, *x.third, *x.first);
  add(y.s, *y.first, *y.second);
  add(y.t, *y.first, *y.third);
  return w;
}

double upper(const Bounded& x) {
  return (x.value() + x.error()) * (1 + 2 * kEps);
}
double lower(const Bounded& x) {
  return (x.value() - x.error()) * (1 - 2 * kEps);
}

/// Of any two points of the sets, n . (x - y) is at least what it is at some corners: a plane across n parts
/// the sets by that much over |n|.
double parted_by(const Vec3& direction, Points a, Points b) {
  const Vector<Bounded> n{Bounded(direction[0]), Bounded(direction[1]), Bounded(direction[2])};
  double least = kInfinity;
  for (const Vec3& x : a)
    for (const Vec3& y : b) least = std::min(least, lower(dot(n, difference<Bounded>(x, y))));
  return least / std::sqrt(upper(dot(n, n))) * (1 - 4 * kEps);
}

/// Of disjoint sets of ordinary numbers; the lower bound may be useless.
fallback::Bounds proven(const Candidate& c, Points a, Points b) {
  const Vector<Bounded> w = apart(c.on_a, c.on_b);
  return {parted_by({w[0].value(), w[1].value(), w[2].value()}, a, b),
          std::sqrt(upper(dot(w, w))) * (1 + 2 * kEps)};
}

/// Less the radii, never below 0. Of two numbers beyond the largest, the difference is taken as that of the
/// largest.
fallback::Bounds less(const fallback::Bounds& cores, double radius_a, double radius_b) {
  const auto outward = [](double x, double sign) {
    return x + sign * (4 * kEps * std::abs(x) + std::numeric_limits<double>::min());
  };
  const double radius = radius_a + radius_b, finite = std::min(radius, std::numeric_limits<double>::max());
  return {std::max(0.0, outward(cores.lower - outward(radius, 1), -1)),
          std::max(0.0, outward(cores.upper - outward(finite, -1), 1))};
}

Distance of_disjoint(Range range, const Shape& a, const Shape& b) {
  const Points p = points_of(a), q = points_of(b);
  const Candidate c = Search(p, q).best();
  fallback::Bounds bounds{0.0, 0.0};
  if (range == Range::ordinary) bounds = proven(c, p, q);
  // The negation is for bounds that are no numbers.
  if (!(bounds.lower > 0.0 && bounds.upper - bounds.lower <= 0x1p-41 * bounds.upper))
    bounds = fallback::distance(p, q);
  if (compare(a.radius, 0.0) > 0 || compare(b.radius, 0.0) > 0) bounds = less(bounds, a.radius, b.radius);
  return {collision::kFree, bounds.lower, bounds.upper, c.on_a.value(), c.on_b.value()};
}

}  // namespace

Distance distance(const Shape& a, const Shape& b) {
  const Range range = std::max(range_of(a), range_of(b));
  if (range == Range::not_finite) return {undecidable(Reason::not_finite), 0.0, kInfinity, {}, {}};
  const Predicates signs(range);
  const Shape x = reduced(signs, a), y = reduced(signs, b);
  const Relation r = relation(range, x, y);
  if (r != Relation::free) return {{r}, 0.0, 0.0, x.points[0], y.points[0]};
  return of_disjoint(range, x, y);
}

}  // namespace tendril::exact
