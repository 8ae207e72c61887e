#pragma once

#include <cmath>

#include "exact/number.h"

namespace tendril::exact {

/// Exact signs of finite doubles: a filter in doubles where they are ordinary, then integers, then numbers of
/// any length.
class Predicates {
 public:
  explicit Predicates(Range range) : ordinary_(range == Range::ordinary) {}

  bool ordinary() const { return ordinary_; }

  /// The sign of (q - p) x (r - p) . (x - p).
  int side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) const;
  /// The sign of coordinate `axis` of (b - a) x (c - a).
  int turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) const;

  int slow_side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) const;
  int slow_turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) const;

 private:
  bool ordinary_;
};

/// The plane of three points as side() needs it, for several points. The determinant is a sum of six products
/// of three differences, each through at most eight roundings: three differences, two products, three sums.
/// `size` is the sum of their absolute values, as much rounded, so |computed - true| <= ((1 + eps)^8 - 1) /
/// (1 - eps)^8 size < 9 eps size. Where size is 0, each product has a factor 0: a difference of doubles is 0
/// only for equal ones.
class Plane {
 public:
  Plane(const Predicates& signs, const Vec3& p, const Vec3& q, const Vec3& r)
      : signs_(signs), p_(p), q_(q), r_(r) {
    const Vec3 u = q - p, v = r - p;
    n_ = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const Vec3 a = u.cwiseAbs(), b = v.cwiseAbs();
    size_ = {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
  }

  int side(const Vec3& x) const {
    const Vec3 w = x - p_;
    const double det = n_[0] * w[0] + n_[1] * w[1] + n_[2] * w[2];
    const double size = size_[0] * std::abs(w[0]) + size_[1] * std::abs(w[1]) + size_[2] * std::abs(w[2]);
    if (signs_.ordinary()) {
      if (std::abs(det) > 9 * kEps * size) return det > 0 ? 1 : -1;
      if (size == 0.0) return 0;
    }
    return signs_.slow_side(p_, q_, r_, x);
  }

 private:
  const Predicates& signs_;
  const Vec3 &p_, &q_, &r_;
  Vec3 n_, size_;
};

inline int Predicates::side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) const {
  return Plane(*this, p, q, r).side(x);
}

/// Two products of two differences, four roundings each: as above with 5 eps.
inline int Predicates::turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) const {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
  const double det = left - right, size = std::abs(left) + std::abs(right);
  if (ordinary_) {
    if (std::abs(det) > 5 * kEps * size) return det > 0 ? 1 : -1;
    if (size == 0.0) return 0;
  }
  return slow_turn(axis, a, b, c);
}

}  // namespace tendril::exact
