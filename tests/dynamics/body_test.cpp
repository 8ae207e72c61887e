#include <gtest/gtest.h>
#include <tendril/base/error.h>
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

using test::after;
using test::alone;
using test::body_of;
using test::by;
using test::kUneven;

const Vec3 kGravity(0.3, 0.0, -9.81);

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
                                         Method::runge_kutta4, Method::explicit_euler, Method::backward_euler,
                                         Method::nystrom),
                         [](const auto& method) { return to_string(method.param); });

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

/// How far energy and work of a driven top are apart after RODAS's steps of one size.
double work_missed(int steps) {
  Scene scene = alone(body_of(kUneven));
  scene.bodies.push_back(body_of(kUneven));
  scene.bodies[1].spin = Vec3(1, 2, -1.5);
  scene.forces = {std::make_shared<Motor>(Vec3(0.5, -0.4, 1.0))};
  const System system(scene);
  const auto work = system.make_workspace();
  State state = system.rest_state();
  const double first = system.energies(state, *work).total();
  Rodas stepper(system);
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(stepper.advance(state, 1.0 / steps).ok());
  return std::abs(system.energies(state, *work).total() - first - state.y[state.y.size() - 1]);
}

TEST(Rodas, CountsTheWorkOnTurningBodiesToItsOrder) {
  const double coarse = work_missed(20);
  const double fine = work_missed(40);
  std::printf("work missed %.2e %.2e, order %.2f\n", coarse, fine, std::log2(coarse / fine));
  EXPECT_GE(std::log2(coarse / fine), 3.5);
}

/// Springs between a body and the world: at its centre, and about its axes as they stood at the start.
struct Bush : Force {
  Bush(const Body& body, double k, double c)
      : at(body.position), axes(body.rotation), stiffness(k), turning(c) {}
  void add(const StateView& state, const Loads& loads) const override {
    loads.bodies[0].force -= stiffness * (state.bodies[0].position - at);
    for (int c = 0; c < 3; ++c)
      loads.bodies[0].torque += 0.5 * turning * state.bodies[0].rotation.col(c).cross(axes.col(c));
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::among({0, 1}); }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    const BodyView& body = state.bodies[0];
    return 0.5 * stiffness * (body.position - at).squaredNorm() +
           0.5 * turning * (3.0 - (axes.transpose() * body.rotation).trace());
  }
  Vec3 at;
  Mat3 axes;
  double stiffness, turning;
};

TEST(Body, RingsAtTheFrequenciesOfItsPrincipalMoments) {
  Body body = body_of(kUneven);
  const Mat3 askew = test::turned({0.7, 0.2, -0.9});
  body.inertia = askew * body.inertia * askew.transpose();
  const auto fastest = [&](double k, double c) {
    Scene scene = alone(body);
    scene.forces = {std::make_shared<Bush>(body, k, c)};
    const System system(scene);
    const auto work = system.make_workspace();
    return system.largest_frequency(system.rest_state(), 16, *work);
  };
  EXPECT_NEAR(fastest(800.0, 1.0), std::sqrt(800.0 / body.mass), 1e-4);
  EXPECT_NEAR(fastest(1.0, 800.0), std::sqrt(800.0 / kUneven[0]), 1e-4);
}

/// A ball on springs, by Verlet: its energy sways and does not drift.
TEST(Body, KeepsItsEnergyByVerletWhereMomentsAreEqual) {
  Body ball = body_of({0.5, 0.5, 0.5});
  Scene scene = alone(ball);
  scene.forces = {std::make_shared<Bush>(ball, 50.0, 8.0)};
  scene.bodies[0].velocity = Vec3(1, 2, 0);
  scene.bodies[0].spin = Vec3(2, -1, 1);
  const System system(scene);
  const auto worst = [&](double step, double time) {
    Simulation simulation(system, system.rest_state(), by(Method::verlet, step));
    double off = 0.0;
    for (int k = 1; k <= 20; ++k) off = std::max(off, std::abs(simulation.run(k * time / 20).imbalance));
    return off;
  };
  const double coarse = worst(0.02, 20.0);
  const double fine = worst(0.01, 20.0);
  const double later = worst(0.02, 200.0);
  std::printf("energy off by %.1e, %.1e at half the step, %.1e after ten times the time\n", coarse, fine,
              later);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
  EXPECT_LT(later, 2.0 * coarse);
}

/// What an anchor lets go goes on with the bodies as they were.
TEST(Body, SpinsOnWhereAnAnchorLetsGo) {
  Body top = body_of({0.6, 0.6, 1.0});
  top.spin = Vec3(3, -2, 5);
  Scene scene = alone(top);
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0, .until = 0.3});
  SimulationOptions options;
  options.tolerance = 1e-9;
  const BodyView at = after(scene, 0.7, options);
  EXPECT_LT((at.rotation - test::symmetric_top(top, 0.7)).norm(), 1e-6);
}

/// Steps are no longer than a body's turn allows, and none is tried in vain for it.
TEST(Body, SetsTheStepsByItsSpin) {
  Body ball = body_of({0.5, 0.5, 0.5});
  ball.spin = Vec3(0, 0, 1000);
  for (const Method method : {Method::cash_karp, Method::rodas, Method::automatic}) {
    Report report;
    after(alone(ball), 1.0, by(method, 0), report);
    std::printf("%s: %ld steps, %ld in vain\n", to_string(method), report.accepted, report.rejected);
    EXPECT_LE(report.rejected, 3);
    EXPECT_LE(report.accepted, 700);
  }
}

}  // namespace
}  // namespace tendril
