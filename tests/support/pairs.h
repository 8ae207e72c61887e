#pragma once

#include <tendril/curve/curve_pair.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/rod.h>

#include <cmath>
#include <numbers>

namespace tendril::test {

/// Curve-pair through a chain of masses, the orientation towards `side`.
inline CurvePair pair_through(const std::vector<Vec3>& p, const Vec3& side, double offset) {
  const Interpolator fit(3, p);
  return CurvePair(fit.knots(), fit.solve(p), fit.solve(orientation_towards(p, side, offset)));
}

/// Twelve masses along the longest side of the points' bounding box, inset by 5 %; `bend` waves of that share
/// of the length in the next longest direction.
inline std::vector<Vec3> axis_through(Points points, double bend) {
  Vec3 low = points.front();
  Vec3 high = low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 size = high - low;
  Eigen::Index along = 0;
  size.maxCoeff(&along);
  std::vector<Vec3> axis;
  for (int i = 0; i < 12; ++i) {
    Vec3 p = 0.5 * (low + high);
    const double s = 0.05 + 0.9 * i / 11.0;
    p[along] = low[along] + s * size[along];
    p[(along + 1) % 3] += bend * size[along] * std::sin(2 * std::numbers::pi * s);
    axis.push_back(p);
  }
  return axis;
}

/// The direction across the axis that axis_through leaves free of bending.
inline Vec3 side_of(const std::vector<Vec3>& axis) {
  Eigen::Index along = 0;
  (axis.back() - axis.front()).cwiseAbs().maxCoeff(&along);
  return Vec3::Unit((along + 2) % 3);
}

}  // namespace tendril::test
