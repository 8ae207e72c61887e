#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"

namespace tendril {
namespace {

System swinging_rod(int nodes = 8, double young = 1e5, std::shared_ptr<const Force> more = nullptr) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(nodes - 1, young, 5e-3));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  if (more) scene.forces.push_back(std::move(more));
  return System(scene);
}

SimulationOptions fixed(Method method, double step) {
  SimulationOptions options;
  options.method = method;
  options.fixed_step = step;
  return options;
}

struct Times : Follower {
  void follow(double time, std::span<const CurvePair>) override { at.push_back(time); }
  std::vector<double> at;
};

TEST(FixedStep, EndsAtOutputsWithEqualStepsBetween) {
  const System system = swinging_rod();
  Simulation simulation(system, system.rest_state(), fixed(Method::verlet, 1e-3));
  Times steps;
  Times outputs;
  simulation.add(steps, Simulation::When::accepted_step);
  simulation.add(outputs, Simulation::When::output);
  const std::vector<double> wanted{0.0, 0.0105, 0.02, 0.02};
  const Report report = simulation.run(0.0301, wanted);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(outputs.at, (std::vector<double>{0.0, 0.0105, 0.02}));
  // 10.5, 9.5 and 10.1 steps' worth, rounded up.
  ASSERT_EQ(steps.at.size(), 11u + 10u + 11u);
  EXPECT_EQ(report.accepted, 32);
  for (std::size_t i = 0; i < 32; ++i) {
    const double step = steps.at[i] - (i > 0 ? steps.at[i - 1] : 0.0);
    EXPECT_NEAR(step, i < 11 ? 0.0105 / 11 : i < 21 ? 0.0095 / 10 : 0.0101 / 11, 1e-15) << i;
  }
  EXPECT_EQ(report.time, 0.0301);
  EXPECT_EQ(report.method, "velocity Verlet");
  EXPECT_EQ(report.rejected, 0);
}

TEST(FixedStep, TakesNoMoreStepsThanItsSizeAsks) {
  const System system = swinging_rod();
  Simulation simulation(system, system.rest_state(), fixed(Method::verlet, 1e-3));
  std::vector<double> outputs;
  for (int i = 1; i <= 30; ++i) outputs.push_back(0.01 * i);
  EXPECT_EQ(simulation.run(0.3, outputs).accepted, 300);
}

TEST(FixedStep, MustBeGivenToTheMethodsThatHaveOneAndOnlyToThose) {
  const System system = swinging_rod();
  SimulationOptions options;
  for (const Method method :
       {Method::verlet, Method::runge_kutta4, Method::explicit_euler, Method::backward_euler}) {
    options.method = method;
    EXPECT_THROW(Simulation(system, system.rest_state(), options), InvalidInput) << to_string(method);
  }
  EXPECT_THROW(Simulation(system, system.rest_state(), fixed(Method::cash_karp, 1e-3)), InvalidInput);
  for (const double bad : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(Simulation(system, system.rest_state(), fixed(Method::verlet, bad)), InvalidInput) << bad;
}

TEST(FixedStep, IsRefusedBeyondTheStabilityLimit) {
  const System system = swinging_rod();
  const double w = system.largest_frequency(system.rest_state(), 16, *system.make_workspace());
  for (const auto& [method, limit] :
       {std::pair{Method::verlet, 2.0}, std::pair{Method::runge_kutta4, 2.82}}) {
    Simulation beyond(system, system.rest_state(), fixed(method, 1.01 * limit / w));
    const Report refused = beyond.run(1.0);
    EXPECT_EQ(refused.stop, Stop::too_stiff);
    EXPECT_EQ(refused.accepted, 0);
    EXPECT_NE(refused.reason.find(refused.method + " needs steps below "), std::string::npos)
        << refused.reason;
    EXPECT_NEAR(refused.guard_step, limit / w, 1e-12);
    Simulation within(system, system.rest_state(), fixed(method, 0.2 * limit / w));
    EXPECT_EQ(within.run(0.2).stop, Stop::finished);
  }
}

TEST(FixedStep, IsRefusedWhereViscosityIsTooStrong) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(7, 1e5, 5e-3));
  scene.rods[0].viscosity = 0.1;
  scene.anchors.push_back({0, 0, true, true, {}});
  const System system(scene);
  const double w = system.largest_frequency(system.rest_state(), 16, *system.make_workspace());
  const double limit = 2.0 / (0.1 * w * w);
  ASSERT_LT(limit, 0.1 * 2.0 / w);
  Simulation beyond(system, system.rest_state(), fixed(Method::verlet, 1.01 * limit));
  EXPECT_EQ(beyond.run(1.0).stop, Stop::too_stiff);
  State stirred = system.rest_state();
  stirred.y[24 + 3 * 5 + 2] = 0.01;
  Simulation within(system, stirred, fixed(Method::verlet, 0.9 * limit));
  EXPECT_EQ(within.run(2000 * limit).stop, Stop::finished);
}

TEST(FixedStep, EndsWhereTheEnergyIsLost) {
  const System system = swinging_rod();
  SimulationOptions options = fixed(Method::explicit_euler, 2e-3);
  Simulation euler(system, system.rest_state(), options);
  const Report gained = euler.run(1.0);
  EXPECT_EQ(gained.stop, Stop::energy_gained);
  EXPECT_GT(gained.imbalance, 1e-2);
  EXPECT_LT(gained.time, 1.0);

  options = fixed(Method::backward_euler, 2e-3);
  Simulation damped(system, system.rest_state(), options);
  EXPECT_LT(damped.run(1.0).imbalance, -1e-2);
  options.energy_limit = 1.0;
  Simulation watched(system, system.rest_state(), options);
  EXPECT_EQ(watched.run(1.0).stop, Stop::finished);
}

TEST(FixedStep, KeepsToTheWorkLimit) {
  const System system = swinging_rod();
  SimulationOptions options = fixed(Method::runge_kutta4, 1e-3);
  options.work_limit = 1000;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(1.0);
  EXPECT_EQ(report.stop, Stop::work_limit);
  EXPECT_LE(report.evaluations, 1005);
}

/// Pushes up, far beyond the weight, what is more than half a metre deep: a long step ends neither below nor
/// above.
struct Trampoline : Force {
  void add(const StateView& state, const Loads& loads) const override {
    for (std::size_t i = 0; i < state.p.size(); ++i)
      if (state.p[i].z() < -0.5) loads.force[i].z() += 100.0;
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
};

TEST(FixedStep, SaysWhenAnImplicitStepFails) {
  const System system = swinging_rod(8, 1e6, std::make_shared<Trampoline>());
  SimulationOptions options = fixed(Method::backward_euler, 0.2);
  options.energy_limit = 10;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(5.0);
  EXPECT_EQ(report.stop, Stop::not_evaluable);
  EXPECT_NE(report.reason.find("implicit step"), std::string::npos) << report.reason;
  EXPECT_TRUE(simulation.state().y.allFinite());
}

TEST(FixedStep, SeesAJumpOfAForceWhereItIs) {
  // The load comes on at a time that is no multiple of the step: order 2 needs a step that ends there.
  const Signal on = Signal::table({{0.1037, 0.0}, {0.1037, 1.0}});
  const System system =
      swinging_rod(8, 1e5, std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 7, Vec3(0, 0.02, 0), on));
  const auto end = [&](const SimulationOptions& options) {
    Simulation simulation(system, system.rest_state(), options);
    EXPECT_EQ(simulation.run(0.3).stop, Stop::finished);
    return Eigen::VectorXd(simulation.state().y.head(24));
  };
  SimulationOptions exact;
  exact.tolerance = 1e-11;
  const Eigen::VectorXd reference = end(exact);
  const double coarse = (end(fixed(Method::verlet, 1e-3)) - reference).norm();
  const double fine = (end(fixed(Method::verlet, 2.5e-4)) - reference).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.3);
}

TEST(FixedStep, GivesTheSameBitsTwice) {
  const System system = swinging_rod();
  for (const Method method :
       {Method::verlet, Method::runge_kutta4, Method::explicit_euler, Method::backward_euler}) {
    const auto run = [&] {
      SimulationOptions options = fixed(method, 1e-3);
      options.energy_limit = 1.0;
      Simulation simulation(system, system.rest_state(), options);
      simulation.run(0.1, std::vector<double>{0.05});
      return simulation.state().y;
    };
    EXPECT_TRUE((run().array() == run().array()).all()) << to_string(method);
  }
}

}  // namespace
}  // namespace tendril
