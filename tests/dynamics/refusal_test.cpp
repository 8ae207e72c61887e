#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>

#include "support/rods.h"

namespace tendril {
namespace {

/// Nothing but a wall: no state has the tip below a height.
struct ShiftedFloor : Force {
  ShiftedFloor(double z, bool says) : height(z), says_so(says) {}
  void add(const StateView& state, const Loads& loads) const override {
    if (state.p[6].z() < height) loads.refuse(6);
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return true; }
  bool refuses() const override { return says_so; }
  double height;
  bool says_so;
};

struct Fallen {
  Report report;
  double height;  ///< of the tip over the floor
};

Fallen fall(double floor, bool says_so, Method method) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -9.81)),
                  std::make_shared<ShiftedFloor>(floor, says_so)};
  const System system(scene);
  SimulationOptions options;
  options.method = method;
  options.tolerance = 1e-3;
  options.energy_limit = 10.0;  // explicit Euler gains, backward Euler loses
  if (!chooses_steps(method)) options.fixed_step = method == Method::explicit_euler ? 1e-4 : 1e-3;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(1.0);
  return {report, simulation.state().y[3 * 6 + 2] - floor};
}

class Refusing : public testing::TestWithParam<Method> {};

TEST_P(Refusing, NoAcceptedStateIsOneThatAForceRefuses) {
  const bool chooses = chooses_steps(GetParam());
  double worst = 0.0;
  for (int k = 0; k < 20; ++k) {
    const Fallen fallen = fall(-0.05 - 0.001 * k, true, GetParam());
    EXPECT_EQ(fallen.report.stop, Stop::not_evaluable);
    EXPECT_GE(fallen.height, 0.0);
    worst = std::max(worst, fallen.height);
    // Backward Euler's iteration finds no state that is not refused.
    if (GetParam() == Method::backward_euler) continue;
    EXPECT_NE(fallen.report.reason.find("rod 0 node 6: a force refuses the state"), std::string::npos)
        << fallen.report.reason;
  }
  std::printf("stopped at most %.1e above\n", worst);
  EXPECT_LT(worst, chooses ? 1e-12 : 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Methods, Refusing,
                         testing::Values(Method::cash_karp, Method::rodas, Method::automatic,
                                         Method::runge_kutta4, Method::explicit_euler, Method::backward_euler,
                                         Method::nystrom),
                         [](const auto& method) { return to_string(method.param); });

TEST(Refusing, IsAskedOfThoseForcesAloneThatSayTheyMayRefuse) {
  // Stages only see where they set out from, and places near the end.
  EXPECT_LT(fall(-0.05, false, Method::explicit_euler).height, 0.0);
  const Fallen told = fall(-2.0, true, Method::runge_kutta4);
  const Fallen untold = fall(-2.0, false, Method::runge_kutta4);
  EXPECT_EQ(told.report.stop, Stop::finished) << told.report.reason;
  EXPECT_EQ(told.height, untold.height);
  EXPECT_EQ(told.report.evaluations, untold.report.evaluations + told.report.accepted);
}

/// Drives a ball so fast that the places which a step's stages see near its end are far from the end.
struct Driven : Force {
  Driven(double z, bool says) : height(z), says_so(says) {}
  void add(const StateView& state, const Loads& loads) const override {
    loads.bodies[0].force.z() -= 400.0 * std::pow(std::sin(20.0 * state.time), 2);
    if (state.bodies[0].position.z() < height) loads.refuse(0);
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  bool refuses() const override { return says_so; }
  double height;
  bool says_so;
};

TEST(Refusing, LooksWhereTheStagesOfAnExplicitStepDoNot) {
  int beyond = 0;
  for (int k = 0; k < 200; ++k)
    for (const bool says_so : {false, true}) {
      Scene scene;
      scene.bodies.emplace_back();
      const double height = -0.1 - 0.01 * k;
      scene.forces = {std::make_shared<Driven>(height, says_so)};
      const System system(scene);
      SimulationOptions options;
      options.tolerance = 0.05;
      options.energy_limit = 10.0;
      Simulation simulation(system, system.rest_state(), options);
      const Report report = simulation.run(1.0);
      EXPECT_NE(report.reason.find("body 0: a force refuses the state"), std::string::npos) << report.reason;
      const bool below = system.bodies(simulation.state()).at(0).position.z() < height;
      if (says_so) EXPECT_FALSE(below) << height;
      beyond += below;
    }
  std::printf("%d of 200 beyond\n", beyond);
  EXPECT_GT(beyond, 0);
}

TEST(Refusing, AStateCanBeAsked) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.forces = {std::make_shared<ShiftedFloor>(-0.5, true)};
  const System system(scene);
  const auto work = system.make_workspace();
  State state = system.rest_state();
  EXPECT_TRUE(system.refusal(state, *work).ok());
  state.y[3 * 6 + 2] = -0.6;
  const Evaluation at = system.refusal(state, *work);
  EXPECT_EQ(at.outcome, Evaluation::Outcome::refused);
  EXPECT_EQ(at.node, 6u);
}

}  // namespace
}  // namespace tendril
