#include <gtest/gtest.h>
#include <tendril/curve/equal_length.h>

#include <numbers>

#include "support/pairs.h"

namespace tendril {
namespace {

/// A straight pair of length 6 along x, and one of the same length (or stretched) round a quarter circle.
CurvePair straight() {
  std::vector<Vec3> p;
  for (int i = 0; i <= 12; ++i) p.emplace_back(0.5 * i, 0, 0);
  return test::pair_through(p, Vec3::UnitZ(), 1.0);
}

CurvePair arc(double length) {
  const double radius = length / (std::numbers::pi / 2);
  std::vector<Vec3> p;
  for (int i = 0; i <= 40; ++i) {
    const double a = std::numbers::pi / 2 * i / 40;
    p.emplace_back(radius * std::sin(a), radius * (1 - std::cos(a)), 0);
  }
  return test::pair_through(p, Vec3::UnitZ(), 1.0);
}

TEST(EqualLength, KeepsDistancesAlongTheAxis) {
  const CurvePair rest = straight();
  const ArcLength rest_length(rest.primary());
  for (const double stretch : {1.0, 1.4}) {
    const CurvePair posed = arc(6.0 * stretch);
    const ArcLength posed_length(posed.primary());
    for (const double x : {0.0, 1.0, 2.5, 5.9}) {
      const AxialPoint record = to_axial(rest, rest_length.parameter_at(x), Vec3(x, 0, 0));
      const AxialPoint moved = at_equal_length(rest_length, posed_length, record);
      // On the arc x lengths along it, whether or not the arc is longer than the rest curve.
      const double angle = x / (6.0 * stretch) * std::numbers::pi / 2;
      const double radius = 6.0 * stretch / (std::numbers::pi / 2);
      const Vec3 expected(radius * std::sin(angle), radius * (1 - std::cos(angle)), 0);
      EXPECT_LT((from_axial(posed, moved) - expected).norm(), 1e-5) << x;
      EXPECT_NEAR(posed_length.length_to(moved.t), x, 1e-11);
      EXPECT_EQ(moved.w, record.w);
    }
  }
}

TEST(EqualLength, GoesStraightOnPastTheEndOfAShorterPose) {
  const CurvePair rest = straight();
  const CurvePair posed = arc(4.0);
  const ArcLength rest_length(rest.primary());
  const ArcLength posed_length(posed.primary());
  const AxialPoint record = to_axial(rest, rest.knots().end(), Vec3(6, 0, 0));
  const AxialPoint moved = at_equal_length(rest_length, posed_length, record);
  EXPECT_EQ(moved.t, posed.knots().end());
  EXPECT_NEAR(moved.w, 6.0 - posed_length.total(), 1e-12);
  // The quarter circle ends along y.
  const Vec3 end = posed.primary().value(1.0);
  EXPECT_LT((from_axial(posed, moved) - end - Vec3(0, 6.0 - posed_length.total(), 0)).norm(), 1e-3);
}

TEST(EqualLength, IsTheIdentityOnTheRestCurve) {
  const CurvePair rest = arc(5.0);
  const ArcLength length(rest.primary());
  for (int i = 0; i <= 20; ++i) {
    const Vec3 point = Vec3(0.2 * i, 0.5, -0.3);
    const AxialPoint record = to_axial(rest, 0.05 * i, point);
    EXPECT_LT((from_axial(rest, at_equal_length(length, length, record)) - point).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace tendril
