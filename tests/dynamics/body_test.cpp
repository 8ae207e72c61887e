#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include <limits>

#include "support/rods.h"
#include "support/tops.h"

namespace tendril {
namespace {

using test::alone;
using test::body_of;

const Vec3 kGravity(0.3, 0.0, -9.81);
const Vec3 kUneven(0.4, 0.7, 1.0);

SimulationOptions by(Method method, double step) {
  SimulationOptions options;
  options.method = method;
  if (!chooses_steps(method)) options.fixed_step = step;
  return options;
}

BodyView after(const Scene& scene, double time, const SimulationOptions& options, Report& report) {
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options);
  report = simulation.run(time);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(simulation.state().time, time);
  return system.bodies(simulation.state()).at(0);
}
BodyView after(const Scene& scene, double time, const SimulationOptions& options) {
  Report report;
  return after(scene, time, options, report);
}

class FreeFall : public testing::TestWithParam<Method> {};

TEST_P(FreeFall, OfABallThatSpins) {
  Body ball = body_of({0.5, 0.5, 0.5});
  ball.velocity = Vec3(1, 2, 3);
  ball.spin = Vec3(3, -1, 2);
  Scene scene = alone(ball);
  scene.forces = {std::make_shared<Gravity>(kGravity)};
  Report report;
  const double t = 0.8;
  const BodyView at = after(scene, t, by(GetParam(), 1e-3), report);
  // Explicit and backward Euler lag by h/2 of the speed gained.
  const bool euler = info(GetParam()).order == 1;
  EXPECT_LT((at.position - (ball.position + t * ball.velocity + 0.5 * t * t * kGravity)).norm(),
            euler ? 0.6e-3 * t * kGravity.norm() : 1e-12);
  EXPECT_LT((at.velocity - ball.velocity - t * kGravity).norm(), 1e-12);
  EXPECT_LT((at.rotation - test::turned(t * ball.spin) * ball.rotation).norm(), 1e-12);
  EXPECT_LT((at.spin - ball.spin).norm(), 1e-13);
  EXPECT_EQ(at.mass, ball.mass);
  const double spinning = 0.5 * 0.5 * ball.spin.squaredNorm();
  EXPECT_NEAR(report.first.kinetic, 0.5 * ball.mass * ball.velocity.squaredNorm() + spinning, 1e-12);
  EXPECT_NEAR(report.first.potential, -ball.mass * kGravity.dot(ball.position), 1e-12);
  EXPECT_LT(std::abs(report.imbalance), euler ? 5e-3 : 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Methods, FreeFall,
                         testing::Values(Method::cash_karp, Method::rodas, Method::automatic, Method::verlet,
                                         Method::runge_kutta4, Method::explicit_euler,
                                         Method::backward_euler),
                         [](const auto& method) { return to_string(method.param); });

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

/// A torque about a fixed axis, without an energy.
struct Motor : Force {
  explicit Motor(const Vec3& t) : torque(t) {}
  void add(const StateView&, const Loads& loads) const override {
    loads.bodies[1].torque += torque;
    loads.bodies[1].add_at({0, 0, 1}, {2, 0, 0}, {0, 0, 1});
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  bool depends_on_time() const override { return false; }
  Vec3 torque;
};

TEST(Body, TakesTorquesAndForcesWithTheirWorkInTheBooks) {
  Scene scene = alone(body_of(kUneven));
  scene.bodies.push_back(body_of({0.5, 0.5, 0.5}));
  const Vec3 torque(0.2, -0.4, 1.0);
  scene.forces = {std::make_shared<Motor>(torque)};
  const System system(scene);
  Simulation simulation(system, system.rest_state());
  const Report report = simulation.run(3.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const std::vector<BodyView> at = system.bodies(simulation.state());
  ASSERT_EQ(at.size(), 2u);
  EXPECT_LT((at[1].spin - 3.0 * torque / 0.5).norm(), 1e-6);
  EXPECT_LT((at[1].velocity - Vec3(3.0, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(at[0].spin.norm() + at[0].velocity.norm(), 0.0);
  const double gained = 0.5 * 0.5 * at[1].spin.squaredNorm() + 0.5 * 2.0 * at[1].velocity.squaredNorm();
  EXPECT_NEAR(report.work, gained, 1e-6 * gained);
  EXPECT_LT(std::abs(report.imbalance), 1e-6);
}

/// A rod and a body that do not touch.
TEST(Body, LeavesTheBitsOfARodAlone) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = {std::make_shared<Gravity>(kGravity)};
  const System without(scene);
  Body top = body_of(kUneven);
  top.spin = Vec3(1, 2, 3);
  scene.bodies = {top};
  const System with(scene);
  ClassicRungeKutta one(without);
  ClassicRungeKutta two(with);
  State a = without.rest_state();
  State b = with.rest_state();
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(one.advance(a, 1e-3).ok());
    ASSERT_TRUE(two.advance(b, 1e-3).ok());
  }
  const Eigen::Index rods = a.y.size() - 1;
  EXPECT_EQ(a.y.head(rods), b.y.head(rods));
  EXPECT_EQ(b.y.size(), a.y.size() + 12);
  const auto work = with.make_workspace();
  EXPECT_GE(with.largest_frequency(b, 16, *work), 2.0 * top.spin.norm());
}

TEST(Body, IsChangedBetweenStepsWithItsEnergyInTheBooks) {
  Body ball = body_of({0.5, 0.5, 0.5});
  ball.velocity = Vec3(0, 0, -2);
  const System system(alone(ball));
  Simulation simulation(system, system.rest_state());
  simulation.run(0.5);
  simulation.change([&](State& state) {
    BodyView at = system.bodies(state).at(0);
    at.velocity.z() *= -0.5;
    at.spin = Vec3(0, 4, 0);
    at.rotation = Mat3::Identity();
    system.set_body(state, 0, at);
  });
  const Report report = simulation.run(1.0);
  const BodyView at = system.bodies(simulation.state()).at(0);
  EXPECT_NEAR(at.position.z(), ball.position.z() - 1.0 + 0.5, 1e-12);
  EXPECT_LT((at.rotation - test::turned({0, 2, 0})).norm(), 1e-12);
  EXPECT_NEAR(report.changed, 0.5 * 2.0 * (1.0 - 4.0) + 0.5 * 0.5 * 16.0, 1e-12);
  EXPECT_LT(std::abs(report.imbalance), 1e-12);
  const auto refused = [&](const auto& how) {
    try {
      simulation.change(how);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused([](State& s) { s.rotation.clear(); }).find("other sizes"), std::string::npos);
  EXPECT_NE(refused([](State& s) { s.rotation[0] *= 2; }).find("rotation[0]"), std::string::npos);
  EXPECT_NE(refused([](State& s) { s.y[0] = std::nan(""); }).find("body 0"), std::string::npos);
  State other = system.rest_state();
  EXPECT_THROW(system.set_body(other, 1, at), InvalidInput);
  BodyView mirrored = at;
  mirrored.rotation = -mirrored.rotation;
  EXPECT_THROW(system.set_body(other, 0, mirrored), InvalidInput);
}

TEST(Body, IsRefusedWithPlaceAndReason) {
  const auto place = [](const auto& how) {
    Scene scene = alone(body_of(kUneven));
    scene.bodies.push_back(body_of(kUneven));
    how(scene.bodies[1]);
    return test::place_of_refusal(scene);
  };
  const double nan = std::nan("");
  EXPECT_EQ(place([](Body&) {}), "accepted");
  for (const double mass : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(place([&](Body& b) { b.mass = mass; }), "bodies[1].mass");
  EXPECT_EQ(place([](Body& b) { b.inertia(0, 1) = 0.1; }), "bodies[1].inertia");
  EXPECT_EQ(place([](Body& b) { b.inertia = Vec3(0.2, 0.3, 0.6).asDiagonal(); }), "bodies[1].inertia");
  EXPECT_EQ(place([](Body& b) { b.inertia = Vec3(0.0, 1.0, 1.0).asDiagonal(); }), "bodies[1].inertia");
  EXPECT_EQ(place([](Body& b) { b.inertia = Vec3(1.0, -1.0, 1.0).asDiagonal(); }), "bodies[1].inertia");
  EXPECT_EQ(place([&](Body& b) { b.inertia(1, 1) = nan; }), "bodies[1].inertia");
  // A plate has no thickness but for rounding.
  EXPECT_EQ(place([](Body& b) { b.inertia = Vec3(0.1, 0.2, 0.3).asDiagonal(); }), "accepted");
  EXPECT_EQ(place([](Body& b) { b.rotation(0, 0) += 1e-6; }), "bodies[1].rotation");
  EXPECT_EQ(place([](Body& b) { b.rotation.col(2) *= -1; }), "bodies[1].rotation");
  EXPECT_EQ(place([&](Body& b) { b.rotation(2, 2) = nan; }), "bodies[1].rotation");
  EXPECT_EQ(place([&](Body& b) { b.position.x() = nan; }), "bodies[1].position");
  EXPECT_EQ(place([&](Body& b) { b.velocity.y() = nan; }), "bodies[1].velocity");
  EXPECT_EQ(place([&](Body& b) { b.spin.z() = nan; }), "bodies[1].spin");
}

TEST(Body, IsRefusedWhereAMethodDoesNotFit) {
  const System uneven(alone(body_of(kUneven)));
  EXPECT_THROW(VelocityVerlet{uneven}, InvalidInput);
  EXPECT_THROW(Simulation(uneven, uneven.rest_state(), by(Method::verlet, 1e-3)), InvalidInput);
  EXPECT_THROW(find_equilibrium(uneven, uneven.rest_state()), InvalidInput);
}

/// Steps that turn a body too far are rejected, and named.
TEST(Body, IsNotTurnedTooFarInAStep) {
  Body ball = body_of({0.5, 0.5, 0.5});
  ball.spin = Vec3(0, 0, 1000);
  const System system(alone(ball));
  ExplicitEuler stepper(system);
  State state = system.rest_state();
  const Evaluation at = stepper.advance(state, 0.003);
  EXPECT_EQ(at.outcome, Evaluation::Outcome::turned_too_far);
  EXPECT_EQ(at.node, 1u);
  const BodyView turned = after(alone(ball), 1.0, {});
  EXPECT_LT((turned.rotation - test::turned({0, 0, std::remainder(1000.0, 2 * M_PI)}) * ball.rotation).norm(),
            1e-9);
}

}  // namespace
}  // namespace tendril
