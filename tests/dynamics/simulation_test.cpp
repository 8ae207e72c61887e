#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cstring>

#include "support/rods.h"

namespace tendril {
namespace {

/// A clamped, damped, anisotropic rod in gravity and gusty wind, its clamp rocked by a hand.
Scene busy_scene() {
  Scene scene;
  const std::vector<Vec3> p = test::straight(10, 1.0);
  Rod rod = make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {2e6, 7e5, 1000},
                     elliptic_section(0.02, 0.012));
  rod.mass_damping = 0.3;
  rod.viscosity = 1e-3;
  scene.rods.push_back(rod);
  Anchor hand;
  hand.motion = [](double t) {
    const double angle = 0.4 * std::sin(3 * t);
    const double rate = 1.2 * std::cos(3 * t);
    AnchorPose pose;
    pose.position = Vec3(0, 0, 0.1 * std::sin(2 * t));
    pose.velocity = Vec3(0, 0, 0.2 * std::cos(2 * t));
    pose.frame.z = rotate_about(Vec3::UnitY(), angle, Vec3::UnitX());
    pose.frame.y = rotate_about(Vec3::UnitY(), angle, Vec3::UnitZ());
    pose.frame.x = pose.frame.y.cross(pose.frame.z);
    pose.angular_velocity = rate * Vec3::UnitY();
    return pose;
  };
  scene.anchors.push_back(hand);
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  WindOptions wind;
  wind.mean = Vec3(0, 6, 1);
  wind.gust = 0.5;
  scene.forces.push_back(std::make_shared<Wind>(wind));
  scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::torque, 0, 10, Vec3(0.02, 0.01, 0),
                                                     Signal::sinusoid(1.0, 1.5)));
  return scene;
}

Report run(const Scene& scene, double until, const SimulationOptions& options, State* end = nullptr) {
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(until);
  if (end) *end = simulation.state();
  return report;
}

TEST(Simulation, BalancesEnergyAgainstWorkWithEverythingInTheScene) {
  SimulationOptions options;
  double before = 0.0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    options.tolerance = tolerance;
    const Report report = run(busy_scene(), 1.0, options);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    std::printf("tolerance %.0e: %ld steps, imbalance %.1e\n", tolerance, report.accepted, report.imbalance);
    EXPECT_LT(std::abs(report.imbalance), 10 * tolerance);
    EXPECT_GT(std::abs(report.work), 1e-3);
    before = report.imbalance;
  }
  EXPECT_LT(std::abs(before), 1e-8);
}

TEST(Simulation, ErrorFollowsTheTolerance) {
  SimulationOptions options;
  options.tolerance = 1e-10;
  State reference;
  ASSERT_EQ(run(busy_scene(), 1.0, options, &reference).stop, Stop::finished);
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    options.tolerance = tolerance;
    State end;
    ASSERT_EQ(run(busy_scene(), 1.0, options, &end).stop, Stop::finished);
    EXPECT_LT((end.y - reference.y).head(33).cwiseAbs().maxCoeff(), 30 * tolerance) << tolerance;
  }
}

TEST(Simulation, GivesTheSameBitsAgain) {
  SimulationOptions options;
  options.tolerance = 1e-5;
  State first;
  State second;
  run(busy_scene(), 0.5, options, &first);
  run(busy_scene(), 0.5, options, &second);
  ASSERT_EQ(first.y.size(), second.y.size());
  EXPECT_EQ(
      std::memcmp(first.y.data(), second.y.data(), sizeof(double) * static_cast<std::size_t>(first.y.size())),
      0);
}

struct Recorder : Follower {
  void follow(double time, std::span<const CurvePair> pairs) override {
    times.push_back(time);
    tips.push_back(pairs[0].primary().control_points().back());
  }
  std::vector<double> times;
  std::vector<Vec3> tips;
};

TEST(Simulation, CallsFollowersOncePerAcceptedStepAndAtOutputs) {
  const System system(busy_scene());
  Simulation simulation(system, system.rest_state());
  Recorder steps;
  Recorder outputs;
  simulation.add(steps, Simulation::When::accepted_step);
  simulation.add(outputs, Simulation::When::output);
  const std::vector<double> times{0.0, 0.1, 0.2, 0.35};
  const Report report = simulation.run(0.4, times);
  ASSERT_EQ(report.stop, Stop::finished);
  EXPECT_EQ(outputs.times, times);
  EXPECT_EQ(static_cast<long>(steps.times.size()), report.accepted);
  EXPECT_EQ(steps.times.back(), 0.4);
  EXPECT_TRUE(std::is_sorted(steps.times.begin(), steps.times.end()));
  // The curve passes through the masses, so its end is the tip.
  EXPECT_NEAR((steps.tips.back() - test::at(simulation.state().y, 10)).norm(), 0.0, 1e-14);
  EXPECT_GE(report.smallest_step, 0.0);
  EXPECT_LE(report.smallest_step, report.largest_step);
  // Going on from where it stopped.
  const Report more = simulation.run(0.5);
  EXPECT_EQ(more.stop, Stop::finished);
  EXPECT_EQ(more.time, 0.5);
}

TEST(Simulation, StopsWhenAsked) {
  const System system(busy_scene());
  Simulation simulation(system, system.rest_state());
  simulation.on_progress([](double time) { return time < 0.05; });
  const Report report = simulation.run(10.0);
  EXPECT_EQ(report.stop, Stop::cancelled);
  EXPECT_GE(report.time, 0.05);
  EXPECT_LT(report.time, 0.5);
}

TEST(Simulation, EndsStepsAtJumpsOfTheLoad) {
  // A free mass-like rod pushed by a force that is switched on at 0.3: x = F (t - 0.3)^2 / 2 M exactly.
  Scene scene;
  scene.rods.push_back(test::straight_rod(2, 1e4, 0.05));
  const double mass = scene.rods[0].mass[0] + scene.rods[0].mass[1] + scene.rods[0].mass[2];
  for (std::size_t node = 0; node < 3; ++node)
    scene.forces.push_back(std::make_shared<PointLoad>(
        PointLoad::Kind::force, 0, node, Vec3(0, scene.rods[0].mass[node] / mass, 0),
        Signal::table({{0.0, 0.0}, {0.3, 0.0}, {0.3, 5.0}, {1.0, 5.0}})));
  SimulationOptions options;
  options.tolerance = 1e-9;
  State end;
  const Report report = run(scene, 1.0, options, &end);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(test::at(end.y, 1).y(), 5.0 * 0.49 / (2 * mass), 1e-12);
  EXPECT_LT(report.rejected, 5);
}

/// A force that breaks down after a while.
struct Broken : Force {
  void add(const StateView& state, const Loads& loads) const override {
    if (state.time > 0.02) loads.force[0].x() += std::numeric_limits<double>::quiet_NaN();
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::within(0); }
};

TEST(Simulation, KeepsTheLastGoodStateWhenAForceFails) {
  Scene scene = busy_scene();
  scene.forces.push_back(std::make_shared<Broken>());
  State end;
  const Report report = run(scene, 1.0, {}, &end);
  EXPECT_EQ(report.stop, Stop::not_evaluable);
  EXPECT_NE(report.reason.find("not finite"), std::string::npos) << report.reason;
  EXPECT_LE(report.time, 0.02);
  EXPECT_GT(report.time, 0.01);
  EXPECT_TRUE(end.y.allFinite());
}

TEST(Simulation, StopsAtItsWorkLimit) {
  SimulationOptions options;
  // Soft springs: the guard lets it pass. A fast load and a tight tolerance do not.
  options.work_limit = 2000;
  options.tolerance = 1e-12;
  Scene scene;
  scene.rods.push_back(test::straight_rod(1, 1.0, 0.05));
  scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 1, Vec3(1, 2, 3),
                                                     Signal::sinusoid(10.0, 500.0)));
  const Report report = run(scene, 1.0, options);
  EXPECT_EQ(report.stop, Stop::work_limit) << to_string(report.stop);
  EXPECT_LT(report.evaluations, 2000 + 50);
  EXPECT_GT(report.time, 0.0);
}

TEST(OwnStepper, TakesThePlaceOfTheMethod) {
  const System system(busy_scene());
  SimulationOptions options;
  Simulation own_method(system, system.rest_state(), options);
  own_method.run(0.05);
  options.method = Method::rodas;
  options.own_stepper = [](const System& of) { return make_stepper(Method::cash_karp, of); };
  Simulation simulation(system, system.rest_state(), options);
  EXPECT_EQ(simulation.run(0.05).method, "Cash-Karp 4(5)");
  EXPECT_EQ(simulation.state().y, own_method.state().y);
}

TEST(OwnStepper, MustEstimateItsErrorOrBeGivenAStep) {
  const System system(busy_scene());
  SimulationOptions options;
  options.own_stepper = [](const System& of) { return make_stepper(Method::runge_kutta4, of); };
  EXPECT_THROW(Simulation(system, system.rest_state(), options), InvalidInput);
  options.fixed_step = 1e-4;
  EXPECT_EQ(Simulation(system, system.rest_state(), options).run(0.01).stop, Stop::finished);
  options.own_stepper = [](const System&) { return std::unique_ptr<Stepper>(); };
  EXPECT_THROW(Simulation(system, system.rest_state(), options), InvalidInput);
}

}  // namespace
}  // namespace tendril
