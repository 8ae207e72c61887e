#pragma once

#include <tendril/collision/continuous.h>

#include "bernstein.h"
#include "time_interval.h"

/// The paths of three vertices relative to the first, and what can be proven about them in doubles.
///
/// Rounding. u = 2^-52 bounds the relative error of one operation in every rounding mode, and g(k) = k u / (1
/// - k u) that of k in a row [Higham 2002], 3.1. Let M_ik be the largest |coordinate k of
/// d_i| over the time-control points as computed, raised to 2^-300 unless it is zero.
///  - A point at a time, or a time-control point of an interval, is always made from the original
///  time-control
///    points, however short the interval: by Degree linear steps one in another, each with the roundings of
///    1 - t, a product and a sum. With the subtraction that made d_i, its coordinates are off by at most g(P)
///    M_ik, P = 1 + 3 Degree.
///  - In a sum of products of p such numbers with k further roundings on each term, every term is off by at
///  most
///    g(p P + k) times the product of its M, so the sum is off by at most that times the sum of those
///    products.
/// in_range() keeps all M below 2^201 and their largest above 2^-250, so nothing overflows. Underflow adds at
/// most 2^-1074 for each operation; it adds nothing to a product with M = 0, which is exactly zero, and with
/// the M at least 2^-300 less than the one u times the product that each bound below has to spare.
namespace tendril::collision {

template <int Degree>
class RelativePaths {
 public:
  explicit RelativePaths(const Paths<Degree>& paths);

  bool finite() const { return finite_; }
  bool in_range() const { return size_along_.maxCoeff() > 0x1p-250 && size_along_.maxCoeff() < 0x1p201; }

  Instant at(double time) const;
  TimeInterval<Degree> interval(const Instant& from, const Instant& to) const;

  /// True only if the features are apart at every time of the interval, along the direction n of their
  /// closest points in its midst: n . (d_i - d_j), d_j zero or not, has no Bernstein coefficient that may be
  /// zero. Error: three terms a vector of one such number, n exact, a product and three sums: at most
  /// 2 g(P + 4) sum_k |n_k| max_i M_ik.
  bool apart(Features features, const TimeInterval<Degree>& on, const Instant& middle) const;

  /// True only if at every time of the interval at which det(d_1, d_2, d_3) = 0 the features meet.
  /// Proof. For every vector m, sum w_i d_i = det(d_1, d_2, d_3) m with w_1 = m . d_2 x d_3 and so on. Take m
  /// = a unit vector of the axes. Vertex-face: where the determinant is zero and the w_i have one sign, not
  /// zero, the first vertex is a convex combination of the corners. Edge-edge, edges from 0 to d_1 and from
  /// d_2 to d_3: w_1, -w_2, -w_3 and -(w_1 + w_2 + w_3) of one sign say it of 0 = (1 - r) d_2 + r d_3 - s d_1
  /// with s = w_1 / (-w_2 - w_3) and r = -w_3 / (-w_2 - w_3), both between 0 and 1. Errors: a coefficient is
  /// a sum with weights that sum to 1; a term has two numbers, its difference, a weight known to u and at
  /// most three sums: at most g(2 P + 8) (M_jx M_ky + M_jy M_kx). The sum of three has two roundings more.
  bool weights_keep_sign(Features features, const TimeInterval<Degree>& on, const Instant& middle) const;

  /// Bernstein coefficients of det(d_1, d_2, d_3) on the interval. Errors: as above, of three numbers and two
  /// products of polynomials: at most g(3 P + 18) times the permanent of M, the sum of the products of all
  /// six terms.
  std::array<double, 3 * Degree + 1> determinant(const TimeInterval<Degree>& on) const;

  /// True only if a polynomial with these coefficients, known to the errors of determinant(), has exactly one
  /// root in the interval and opposite signs at its ends: the coefficients change sign once (Descartes), as
  /// they do with at most one of unknown sign between the sure ones.
  bool has_one_root(const std::array<double, 3 * Degree + 1>& coefficients) const;

  /// What coordinates are multiplied by, a power of two.
  double scale() const { return scale_; }
  double permanent() const { return permanent_; }
  /// Of determinant().
  double coefficient_error() const;

 private:
  template <Features features>
  bool apart_along(const TimeInterval<Degree>& on, const Vec3& n) const;
  int side_at(const Nine& place) const;
  double minor_size(int first, int second, int x, int y) const;

  std::array<Nine, Degree + 1> control_;
  Mat3 size_of_ = Mat3::Zero();     ///< M_ik, a column a vector
  Vec3 size_along_ = Vec3::Zero();  ///< the largest M_ik of each coordinate
  double scale_ = 1.0;
  double permanent_ = 0.0;  ///< of M
  bool finite_ = true;
};

}  // namespace tendril::collision
