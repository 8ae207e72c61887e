#include <gtest/gtest.h>
#include <tendril/dynamics/backward_euler.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/rodas.h>

#include <cmath>

#include "support/tops.h"

namespace tendril {
namespace {

using test::after;
using test::alone;
using test::body_of;
using test::by;
using test::kUneven;

class FreeTop : public testing::TestWithParam<Method> {};

TEST_P(FreeTop, PrecessesAsTheClosedFormSays) {
  for (const Vec3& moments : {Vec3(0.6, 0.6, 1.0), Vec3(0.9, 0.9, 0.2)}) {
    Body top = body_of(moments);
    top.spin = Vec3(3, -2, 5);
    SimulationOptions options = by(GetParam(), 5e-4);
    options.tolerance = 1e-9;
    const double t = 3.0;
    const BodyView at = after(alone(top), t, options);
    const double off = (at.rotation - test::symmetric_top(top, t)).norm();
    std::printf("%s: off by %.1e after %.1f turns\n", to_string(GetParam()), off,
                t * top.spin.norm() / (2 * M_PI));
    EXPECT_LT(off, 2e-7);
  }
}

/// A top that spins about its middle axis turns over again and again.
TEST_P(FreeTop, TurnsOverInTheTimeOfTheEllipticIntegral) {
  Body top = body_of(kUneven);
  const Vec3 spin(0.0, 4.0, 0.08);
  top.spin = top.rotation * spin;
  const Vec3 momentum = test::angular_momentum(top, {{}, top.rotation, {}, top.spin, top.mass});
  // From the middle axis, at rest in the others but one, a quarter of the way round and more.
  const double period = test::period_of_top(kUneven, spin);
  SimulationOptions options = by(GetParam(), 5e-4);
  options.tolerance = 1e-9;
  Report report;
  const BodyView half = after(alone(top), period / 2, options, report);
  const Vec3 own = half.rotation.transpose() * half.spin;
  std::printf("%s: period %.6f, off by %.1e\n", to_string(GetParam()), period,
              (own - Vec3(0.0, -4.0, 0.08)).norm());
  EXPECT_LT((own - Vec3(0.0, -4.0, 0.08)).norm(), 1e-5);
  EXPECT_LT((test::angular_momentum(top, half) - momentum).norm(), 1e-7 * momentum.norm());
  EXPECT_LT(std::abs(report.imbalance), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Methods, FreeTop,
                         testing::Values(Method::cash_karp, Method::rodas, Method::runge_kutta4),
                         [](const auto& method) { return to_string(method.param); });

/// The numbers of a body after some steps of one size.
Eigen::VectorXd stepped(const System& system, Stepper& stepper, double time, int steps) {
  State state = system.rest_state();
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(stepper.advance(state, time / steps).ok());
  const BodyView at = system.bodies(state).at(0);
  Eigen::VectorXd all(12);
  all << at.rotation.col(0), at.rotation.col(1), at.rotation.col(2), at.spin;
  return all;
}

template <class S>
double order_on_a_top(int steps) {
  Body top = body_of(kUneven);
  top.spin = Vec3(1, 2, -1.5);
  const System system(alone(top));
  S stepper(system);
  const Eigen::VectorXd exact = stepped(system, stepper, 2.0, 16 * steps);
  const double coarse = (stepped(system, stepper, 2.0, steps) - exact).norm();
  const double fine = (stepped(system, stepper, 2.0, 2 * steps) - exact).norm();
  std::printf("errors %.2e %.2e, order %.2f\n", coarse, fine, std::log2(coarse / fine));
  return std::log2(coarse / fine);
}

TEST(FreeTop, IsFollowedToTheOrdersOfTheMethods) {
  EXPECT_NEAR(order_on_a_top<CashKarp>(20), 5.0, 0.3);
  EXPECT_NEAR(order_on_a_top<ClassicRungeKutta>(40), 4.0, 0.2);
  EXPECT_NEAR(order_on_a_top<Rodas>(40), 4.0, 0.3);
  EXPECT_NEAR(order_on_a_top<ExplicitEuler>(800), 1.0, 0.2);
  EXPECT_NEAR(order_on_a_top<BackwardEuler>(800), 1.0, 0.2);
}

TEST(Body, StaysOrthonormalThroughThousandsOfTurns) {
  Body top = body_of({0.9, 0.9, 0.3});
  top.spin = Vec3(1, 2, 3);
  const System system(alone(top));
  State state = system.rest_state();
  CashKarp stepper(system);
  const double h = 0.2 / top.spin.norm();
  const long steps = std::lround(3000 * 2 * M_PI / 0.2);
  for (long i = 0; i < steps; ++i) ASSERT_TRUE(stepper.advance(state, h).ok());
  const Mat3 r = system.bodies(state).at(0).rotation;
  EXPECT_LT((r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(), 2e-15);
  // The axis stays at its angle to the angular momentum.
  const auto lean = [&](const BodyView& at) {
    return at.rotation.col(2).dot(test::angular_momentum(top, at).normalized());
  };
  EXPECT_NEAR(lean(system.bodies(state).at(0)), lean(system.bodies(system.rest_state()).at(0)), 1e-3);
}

}  // namespace
}  // namespace tendril
