#pragma once

#include <tendril/base/export.h>

#include <array>
#include <span>
#include <vector>

namespace tendril {

/// Highest degree of a B-spline here.
inline constexpr int kMaxDegree = 5;
/// Highest order of derivative that KnotVector::basis returns.
inline constexpr int kMaxDerivative = 3;

/// The degree + 1 basis functions that do not vanish at a parameter, with derivatives.
struct Basis {
  int first = 0;  ///< index of the first of them, and of the first control point they weigh
  /// value[k][j] is the k-th derivative of N_{first + j, p}; entries beyond the degree are 0.
  std::array<std::array<double, kMaxDegree + 1>, kMaxDerivative + 1> value{};
};

/// A clamped knot vector: k_0 = ... = k_p < ... < k_{m-p} = ... = k_m with m = n + p + 1 for n + 1 control
/// points. Interior knots may repeat up to p times (the curve stays continuous).
class TENDRIL_CORE_API KnotVector {
 public:
  /// \param degree  1 to 5
  /// \param knots   finite, non-decreasing, clamped, at least 2 (degree + 1) of them
  /// Throws InvalidInput naming the first offending knot.
  KnotVector(int degree, std::vector<double> knots);

  /// Clamped on [0, 1], interior knots equally spaced. Needs control_points > degree.
  static KnotVector uniform(int degree, int control_points);

  int degree() const { return degree_; }  ///< p
  /// n + 1, how many control points the knots ask for.
  int control_points() const { return static_cast<int>(knots_.size()) - degree_ - 1; }
  std::span<const double> knots() const { return knots_; }  ///< k_0 ... k_m, valid as long as the vector
  double start() const { return knots_.front(); }           ///< of the domain
  double end() const { return knots_.back(); }              ///< of the domain

  /// Index i with knots[i] <= t < knots[i + 1], after clamping t to [start, end]; t = end belongs to the last
  /// non-empty span. O(log n).
  int span(double t) const;

  /// Basis functions at t (clamped to the domain) and their derivatives up to `derivatives` <= 3, by the
  /// recurrence of Cox and de Boor [de Boor 2001] and its derivative. At a knot the span to the right is
  /// meant, at the end the one to the left. O(p^2), no allocation.
  Basis basis(double t, int derivatives = 0) const;

  /// Same, in a span the caller names: gives one-sided derivatives at a knot.
  Basis basis_in_span(double t, int span, int derivatives) const;

  /// Indices i of the non-empty spans [k_i, k_{i+1}), ascending.
  std::vector<int> nonempty_spans() const;

  /// Same degree, same knots to the last bit.
  bool operator==(const KnotVector&) const = default;

 private:
  int degree_;
  std::vector<double> knots_;
};

}  // namespace tendril
