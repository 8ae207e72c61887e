#pragma once

#include <tendril/collision/continuous.h>

#include "twofold.h"

namespace tendril::collision {

/// The determinant of RelativePaths at a time, of the same paths, with twice the digits: where two features
/// graze each other it crosses zero so flatly that doubles lose the time among their roundings.
template <int Degree>
class SharpDeterminant {
 public:
  /// \param scale  that of RelativePaths
  SharpDeterminant(const Paths<Degree>& paths, double scale);

  /// Off by at most 2^-52 of itself and error() of the permanent of RelativePaths, which must exceed
  /// least_permanent. Proof. With v = Twofold::error, the weights of the time-control points are off by at
  /// most g(3 Degree), a coordinate has 1 + Degree + 1 roundings more, and the determinant, of three of them,
  /// 5 more: as in RelativePaths all is within 64 v of the permanent, times the 3 of a cubic's weights to the
  /// third power at most.
  double operator()(double time) const;

  static constexpr double error() { return 0x1p-84; }
  /// What underflows is below 2^-600 beside the largest numbers there may be.
  static constexpr double least_permanent = 0x1p-500;

 private:
  std::array<std::array<Twofold, 9>, Degree + 1> control_;
};

}  // namespace tendril::collision
