#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>

#include <vector>

namespace tendril {

/// Arc length of a B-spline, s(t) = integral of |c'| from the start to t, and its inverse.
///
/// Ten-point Gauss-Legendre on cells: every span is halved until a cell agrees with its two halves to 1e-14
/// of the total, so that s(t) is within 1e-12 of the total (absolute, same unit as the control points) also
/// next to points of zero speed, where |c'| has a kink. Built in O(cells), 2 per span on smooth curves;
/// independent of the curve afterwards.
class TENDRIL_CORE_API ArcLength {
 public:
  /// \param curve  copied; any, a single point included. A speed whose square overflows is InvalidInput.
  explicit ArcLength(const BSpline& curve);

  double total() const { return lengths_.back(); }  ///< of the whole curve [length]

  /// s(t), from 0 to total(); t is clamped to the domain, a NaN is InvalidInput. Does not decrease beyond
  /// rounding (1e-15 of the total), and is exact at both ends. O(log cells) and ten evaluations of c'.
  double length_to(double t) const;

  /// The parameter at arc length s, clamped to [0, total()]; a NaN is InvalidInput. Where the curve rests (a
  /// stretch of length 0) the smallest such parameter. Newton's method inside a shrinking bracket:
  /// length_to() of the result is s to 1e-14 of the total, or t is the best double there is.
  double parameter_at(double s) const;

 private:
  double from_cell(std::size_t cell, double t) const;
  double speed(double t) const;

  BSpline curve_;
  std::vector<double> parameters_;  // cell boundaries, ascending
  std::vector<double> lengths_;     // s there
};

}  // namespace tendril
