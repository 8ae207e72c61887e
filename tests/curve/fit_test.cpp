#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/control_forces.h>

#include <cmath>

#include "support/random.h"

namespace tendril {
namespace {

using test::Random;

std::vector<Vec3> random_chain(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<Vec3> points{Vec3::Zero()};
  // Steps over two decades: averaged knots of an uneven chain.
  for (int i = 1; i < count; ++i) {
    const Vec3 way = Vec3::UnitX() + random.in_cube(0.7);
    points.push_back(points.back() + std::pow(10.0, random.uniform(-1, 1)) * way);
  }
  return points;
}

class EveryFit : public testing::TestWithParam<std::tuple<int, Parametrisation>> {};
INSTANTIATE_TEST_SUITE_P(
    Fits, EveryFit,
    testing::Combine(testing::Values(1, 2, 3, 4, 5),
                     testing::Values(Parametrisation::uniform, Parametrisation::chord_length,
                                     Parametrisation::centripetal, Parametrisation::universal)));

TEST_P(EveryFit, PassesThroughThePoints) {
  const auto [degree, how] = GetParam();
  for (const int count : {degree + 1, degree + 2, 9, 60}) {
    const std::vector<Vec3> rest = random_chain(5, count);
    const Interpolator fit(degree, rest, how);
    // Other data on frozen parameters: the way every step of a simulation uses it.
    const std::vector<Vec3> data = random_chain(6, count);
    const BSpline curve(fit.knots(), fit.solve(data));
    const double size = (data.back() - data.front()).norm();
    for (std::size_t k = 0; k < data.size(); ++k)
      EXPECT_NEAR((curve.value(fit.parameters()[k]) - data[k]).norm() / size, 0.0, 1e-11)
          << k << " of " << count;
  }
}

/// Moves of the masses and turns of their frames, against what the control points then do.
TEST_P(EveryFit, TakesForcesBackToTheMasses) {
  const auto [degree, how] = GetParam();
  const std::vector<Vec3> points = random_chain(5, 14);
  const Interpolator fit(degree, points, how);
  Random random(6);
  std::vector<Vec3> arm, dp, turn, dq;
  ControlForces forces;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (auto* list : {&arm, &dp, &turn, &forces.primary, &forces.orientation})
      list->push_back(random.in_cube());
    dq.push_back(dp[i] + turn[i].cross(arm[i]));
  }
  const std::vector<Vec3> du = fit.solve(dp), dv = fit.solve(dq);
  const MassLoads loads = loads_on_masses(fit, forces, arm);
  double controls = 0.0, masses = 0.0, size = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    controls += forces.primary[i].dot(du[i]) + forces.orientation[i].dot(dv[i]);
    masses += loads.force[i].dot(dp[i]) + loads.torque[i].dot(turn[i]);
    size += du[i].norm() + dv[i].norm();
  }
  EXPECT_NEAR(controls, masses, 1e-12 * size);
  arm.pop_back();
  EXPECT_THROW(loads_on_masses(fit, forces, arm), InvalidInput);
  EXPECT_THROW(fit.solve_transposed(arm), InvalidInput);
}

TEST(FitParameters, FollowTheirFormulas) {
  const std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {1, 4, 0}, {1, 4, 9}};
  const auto r = [&](Parametrisation how) { return Interpolator(2, rest, how).parameters(); };
  EXPECT_EQ(r(Parametrisation::uniform), (std::vector<double>{0, 1.0 / 3, 2.0 / 3, 1}));
  EXPECT_EQ(r(Parametrisation::chord_length), (std::vector<double>{0, 1.0 / 14, 5.0 / 14, 1}));
  EXPECT_EQ(r(Parametrisation::centripetal), (std::vector<double>{0, 1.0 / 6, 3.0 / 6, 1}));
  // Quadratic on knots 0 0 0 1/2 1 1 1: N_1 = 4t - 6t^2 on [0, 1/2] peaks at 1/3, N_2 by symmetry at 2/3.
  const auto universal = r(Parametrisation::universal);
  EXPECT_NEAR(universal[1], 1.0 / 3, 1e-15);
  EXPECT_NEAR(universal[2], 2.0 / 3, 1e-15);
}

TEST(FitKnots, AverageTheParameters) {
  const std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {1, 4, 0}, {1, 4, 9}};
  const Interpolator fit(2, rest, Parametrisation::centripetal);
  const std::vector<double> expected{0, 0, 0, (1.0 / 6 + 3.0 / 6) / 2, 1, 1, 1};
  ASSERT_EQ(fit.knots().knots().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(fit.knots().knots()[i], expected[i]);
}

TEST(FitInput, IsRefusedWithThePlace) {
  const std::vector<Vec3> twice{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_THROW(Interpolator(3, twice), InvalidInput);
  EXPECT_NO_THROW(Interpolator(3, twice, Parametrisation::uniform));
  EXPECT_THROW(Interpolator(4, twice, Parametrisation::uniform), InvalidInput);
  const std::vector<Vec3> bad{{0, 0, 0}, {1, 0, 0}, {std::nan(""), 0, 0}, {2, 0, 0}};
  EXPECT_THROW(Interpolator(3, bad), InvalidInput);
  EXPECT_THROW(Interpolator(1, twice, Parametrisation::uniform).solve(Points(twice).first(3)), InvalidInput);
}

}  // namespace
}  // namespace tendril
