#pragma once

#include <tendril/base/types.h>
#include <tendril/collision/answer.h>

#include <algorithm>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <limits>
#include <vector>

/// The relation and the distance of convex hulls of few points from their Minkowski difference, in whole
/// numbers and rationals without rounding: a witness that shares nothing with the library but the definition.
namespace tendril::test {

using Whole = boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;
using Ratio =
    boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

template <class N>
struct Exact3 {
  N x, y, z;
  friend Exact3 operator-(const Exact3& a, const Exact3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend N dot(const Exact3& a, const Exact3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Exact3 cross(const Exact3& a, const Exact3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend bool zero(const Exact3& a) { return a.x == 0 && a.y == 0 && a.z == 0; }
};
using Whole3 = Exact3<Whole>;

/// The exponent of the unit in which all numbers are whole.
inline int unit_exponent(Points points) {
  int least = std::numeric_limits<int>::max();
  for (const Vec3& p : points)
    for (const double x : p) {
      if (x == 0.0) continue;
      int e;
      double m = std::frexp(x, &e);
      while (m != std::floor(m)) m *= 2, --e;
      least = std::min(least, e);
    }
  return least == std::numeric_limits<int>::max() ? 0 : least;
}

inline Whole in_units(double x, int exponent) {
  int e;
  const double m = std::frexp(x, &e);
  Whole whole(static_cast<long>(std::ldexp(m, 53)));
  e -= 53 + exponent;
  return e >= 0 ? Whole(whole << e) : Whole(whole / (Whole(1) << -e));
}

/// All differences of a point of a and one of b, times a power of two.
inline std::vector<Whole3> differences(Points a, Points b, int exponent) {
  const auto whole = [&](const Vec3& p) {
    return Whole3{in_units(p.x(), exponent), in_units(p.y(), exponent), in_units(p.z(), exponent)};
  };
  std::vector<Whole3> out;
  for (const Vec3& x : a)
    for (const Vec3& y : b) out.push_back(whole(x) - whole(y));
  return out;
}

inline int common_exponent(Points a, Points b) {
  std::vector<Vec3> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  return unit_exponent(all);
}

/// Where 0 lies to the hull of points: outside, on its boundary or within, by support planes. Every facet's
/// normal of a full hull is among the cross products of the directions; for flat ones so are those of its
/// plane and of its sides.
class SupportPlanes {
 public:
  explicit SupportPlanes(std::vector<Whole3> points, std::vector<Whole3> directions)
      : points_(std::move(points)), directions_(std::move(directions)) {}

  collision::Relation relation() const {
    bool full = false, on_boundary = false;
    std::vector<Whole3> normals;
    for (std::size_t i = 0; i < directions_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Whole3 n = cross(directions_[i], directions_[j]);
        if (zero(n)) continue;
        const auto [low, high] = range(n);
        if (low > 0 || high < 0) return collision::Relation::free;
        on_boundary = on_boundary || low == 0 || high == 0;
        for (const Whole3& d : directions_) full = full || dot(n, d) != 0;
        normals.push_back(n);
      }
    if (full) return on_boundary ? collision::Relation::touching : collision::Relation::hit;
    return parted_within(normals) ? collision::Relation::free : collision::Relation::touching;
  }

 private:
  std::pair<Whole, Whole> range(const Whole3& axis) const {
    Whole low = dot(points_[0], axis), high = low;
    for (const Whole3& p : points_) {
      const Whole x = dot(p, axis);
      if (x < low) low = x;
      if (x > high) high = x;
    }
    return {low, high};
  }
  bool parts(const Whole3& axis) const {
    const auto [low, high] = range(axis);
    return low > 0 || high < 0;
  }
  /// The hull is flat: within its plane, its line, or as a point.
  bool parted_within(const std::vector<Whole3>& normals) const {
    if (parts(points_[0])) return true;
    for (const Whole3& d : directions_) {
      if (parts(d) || parts(cross(d, cross(points_[0], d)))) return true;
      for (const Whole3& n : normals)
        if (parts(cross(n, d))) return true;
    }
    return false;
  }
  std::vector<Whole3> points_, directions_;
};

inline collision::Relation minkowski_relation(Points a, Points b) {
  const int exponent = common_exponent(a, b);
  std::vector<Whole3> directions;
  for (const Points p : {a, b})
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        directions.push_back(differences(p.subspan(i, 1), p.subspan(j, 1), exponent)[0]);
  return SupportPlanes(differences(a, b, exponent), directions).relation();
}

/// The square of the distance of 0 to the hull of points, which it is not in: the nearest point lies within
/// the hull of three of them or fewer, and is there the nearest of their plane, line or point.
inline Ratio least_square(const std::vector<Whole3>& points) {
  Ratio least = dot(points[0], points[0]);
  const auto offer = [&](const Whole& above, const Whole& below) {
    const Ratio square(above, below);
    if (square < least) least = square;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Whole3& p = points[i];
    offer(dot(p, p), 1);
    for (std::size_t j = 0; j < i; ++j) {
      const Whole3 u = points[j] - p;
      const Whole uu = dot(u, u), pu = -dot(p, u);
      if (uu != 0 && pu >= 0 && pu <= uu) offer(dot(p, p) * uu - pu * pu, uu);
      for (std::size_t k = 0; k < j; ++k) {
        const Whole3 v = points[k] - p;
        const Whole vv = dot(v, v), uv = dot(u, v), pv = -dot(p, v), all = uu * vv - uv * uv;
        const Whole s = pu * vv - pv * uv, t = pv * uu - pu * uv;
        if (all == 0 || s < 0 || t < 0 || s + t > all) continue;
        const Whole height = dot(p, cross(u, v));
        offer(height * height, all);
      }
    }
  }
  return least;
}

/// The square of the distance of two hulls in units of 4^exponent (common_exponent or less); 0 where they
/// meet.
inline Ratio minkowski_square(Points a, Points b, int exponent) {
  if (minkowski_relation(a, b) != collision::Relation::free) return 0;
  return least_square(differences(a, b, exponent));
}

}  // namespace tendril::test
