#pragma once

#include <tendril/base/types.h>

#include <array>
#include <initializer_list>
#include <utility>

#include "exact/number.h"

/// The polynomials whose signs decide, for any number type with sums, products and sign(): doubles with error
/// bounds, and numbers without rounding.
namespace tendril::exact {

template <class N>
using Vector = std::array<N, 3>;

template <class N>
Vector<N> difference(const Vec3& a, const Vec3& b) {
  return {N(a[0]) - N(b[0]), N(a[1]) - N(b[1]), N(a[2]) - N(b[2])};
}
template <class N>
N dot(const Vector<N>& a, const Vector<N>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class N>
Vector<N> cross(const Vector<N>& a, const Vector<N>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// (q - p) x (r - p) . (x - p): on which side of the plane p, q, r the point x lies.
template <class N>
N side_polynomial(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) {
  return dot(cross(difference<N>(q, p), difference<N>(r, p)), difference<N>(x, p));
}

/// Coordinate `axis` of (b - a) x (c - a): which way a, b, c turn when seen along that axis.
template <class N>
N turn_polynomial(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  return (N(b[i]) - N(a[i])) * (N(c[j]) - N(a[j])) - (N(b[j]) - N(a[j])) * (N(c[i]) - N(a[i]));
}

/// A squared distance as a fraction; the denominator is positive where valid.
template <class N>
struct Fraction {
  N above, below;
};

/// Features of two disjoint simplices whose distance may be that of the simplices. A feature counts where its
/// points lie within the features' interiors: `valid` gives the sign of the least of what must be positive
/// (kUnknown included).
template <class N>
int all_positive(std::initializer_list<N> values) {
  int least = 1;
  for (const N& x : values) {
    const int s = sign(x);
    if (s == -1 || s == 0) return -1;
    if (s != 1) least = s;
  }
  return least;
}

template <class N>
struct PointPoint {
  Vector<N> w;
  PointPoint(const Vec3& a, const Vec3& b) : w(difference<N>(a, b)) {}
  Fraction<N> square() const { return {dot(w, w), N(1.0)}; }
  int valid() const { return 1; }
};

template <class N>
struct PointEdge {
  Vector<N> w, d;
  PointEdge(const Vec3& x, const Vec3& a, const Vec3& b) : w(difference<N>(x, a)), d(difference<N>(b, a)) {}
  Fraction<N> square() const {
    const Vector<N> c = cross(w, d);
    return {dot(c, c), dot(d, d)};
  }
  int valid() const {
    const N along = dot(w, d);
    return all_positive({along, dot(d, d) - along});
  }
};

template <class N>
struct PointFace {
  Vector<N> w, u, v, n;
  PointFace(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c)
      : w(difference<N>(x, a)), u(difference<N>(b, a)), v(difference<N>(c, a)), n(cross(u, v)) {}
  Fraction<N> square() const {
    const N height = dot(n, w);
    return {height * height, dot(n, n)};
  }
  /// The barycentric coordinates of the foot, times |n|^2.
  int valid() const {
    const N at_c = dot(cross(u, w), n), at_b = dot(cross(w, v), n);
    return all_positive({at_b, at_c, dot(n, n) - at_b - at_c});
  }
};

template <class N>
struct EdgeEdge {
  Vector<N> w, d, e, c;
  EdgeEdge(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q)
      : w(difference<N>(p, a)), d(difference<N>(b, a)), e(difference<N>(q, p)), c(cross(d, e)) {}
  Fraction<N> square() const {
    const N height = dot(w, c);
    return {height * height, dot(c, c)};
  }
  /// The parameters of the lines' nearest points, times |c|^2; parallel edges are left to their ends.
  int valid() const {
    const N s = dot(cross(w, e), c), t = dot(cross(w, d), c), all = dot(c, c);
    return all_positive({s, all - s, t, all - t});
  }
};

/// Calls visit(feature) for every pair of features of two simplices of one to three points each.
template <class N, class Visit>
void for_each_feature(Points a, Points b, Visit&& visit) {
  const auto edges = [](Points p) { return p.size() == 3 ? 3 : p.size() - 1; };
  const auto next = [](Points p, std::size_t i) -> const Vec3& { return p[(i + 1) % p.size()]; };
  for (const Vec3& x : a)
    for (const Vec3& y : b) visit(PointPoint<N>(x, y));
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)})
    for (const Vec3& x : p)
      for (std::size_t i = 0; i < edges(q); ++i) visit(PointEdge<N>(x, q[i], next(q, i)));
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, a)})
    for (const Vec3& x : p)
      if (q.size() == 3) visit(PointFace<N>(x, q[0], q[1], q[2]));
  for (std::size_t i = 0; i < edges(a); ++i)
    for (std::size_t j = 0; j < edges(b); ++j) visit(EdgeEdge<N>(a[i], next(a, i), b[j], next(b, j)));
}

/// Sign of (distance of a and b) - (sum of the radii), of disjoint simplices; kUnknown where sign() does not
/// know. What lies farther than the radii need not be valid to be left out.
template <class N>
int compare_distance(Points a, Points b, double radius_a, double radius_b) {
  const N radius = N(radius_a) + N(radius_b), square = radius * radius;
  bool nearer = false, equal = false, unknown = false;
  for_each_feature<N>(a, b, [&](const auto& feature) {
    if (nearer) return;
    const Fraction<N> f = feature.square();
    const int s = sign(f.above - square * f.below);
    if (s == 1) return;
    const int valid = feature.valid();
    if (valid == -1) return;
    nearer = valid == 1 && s == -1;
    equal = equal || (valid == 1 && s == 0);
    unknown = unknown || valid == kUnknown || s == kUnknown;
  });
  if (nearer) return -1;
  if (unknown) return kUnknown;
  return equal ? 0 : 1;
}

}  // namespace tendril::exact
