#include <gtest/gtest.h>
#include <tendril/dynamics/backward_euler.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include <cstdio>

#include "support/rods.h"

namespace tendril {
namespace {

/// Pushes a mass up below a height and down above it.
struct BackAndForth : Force {
  void add(const StateView& state, const Loads& loads) const override {
    loads.force[1].z() += state.p[1].z() <= 1e-3 ? 1.0 : -1.0;
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
};

TEST(BackwardEuler, SaysWhenItsEquationsHaveNoRoot) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(1, 1e6, 5e-3));
  scene.forces.push_back(std::make_shared<BackAndForth>());
  const System system(scene);
  State state = system.rest_state();
  const Eigen::VectorXd start = state.y;
  BackwardEuler stepper(system);
  EXPECT_EQ(stepper.advance(state, 1.0).outcome, Evaluation::Outcome::not_converged);
  EXPECT_EQ(state.y, start);
  EXPECT_TRUE(stepper.advance(state, 1e-3).ok());
}

System cantilever(double young) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(31, young, 5e-3));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  return System(scene);
}

TEST(BackwardEuler, TakesALimpRodInLongSteps) {
  const System system = cantilever(1e6);
  State state = system.rest_state();
  BackwardEuler stepper(system);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(stepper.advance(state, 0.2).ok()) << i;
  const Equilibrium hanging = find_equilibrium(system, system.rest_state());
  ASSERT_EQ(hanging.balance, Balance::converged);
  EXPECT_LT((state.y.segment<3>(93) - hanging.state.y.segment<3>(93)).norm(), 1e-3);
}

/// Where the last mass of a chain of three hardly stretching edges is after swinging down for 0.4 s.
template <class Run>
Vec3 end_of_stiff_chain(const Run& run) {
  Scene scene;
  const std::vector<Vec3> p{{1, 1, 0}, {1.2, 1, 0}, {1.4, 1, 0}, {1.6, 1, 0}};
  const SpringConstants springs{.stretch = 1e12,
                                .bend_l = 0.01,
                                .bend_m = 0.01,
                                .bend_t = 0,
                                .twist = 0.01,
                                .mass = 0.02,
                                .inertia = 1e-5};
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), springs));
  scene.rods[0].mass_damping = 0.5;
  scene.anchors.push_back({0, 0, true, false, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, -9.81, 0)));
  const System system(scene);
  return run(system).template segment<3>(9);
}

/// The step's equations have other roots, with edges turned over, and Newton's way from the last velocities
/// leads to one of those now and then.
TEST(BackwardEuler, KeepsToTheRootThatAGrowingStepLeadsTo) {
  const Vec3 truth = end_of_stiff_chain([](const System& system) {
    SimulationOptions options;
    options.method = Method::rodas;
    options.tolerance = 1e-6;
    Simulation simulation(system, system.rest_state(), options);
    EXPECT_EQ(simulation.run(0.4).stop, Stop::finished);
    return simulation.state().y;
  });
  std::vector<double> errors;
  for (const int steps : {128, 256, 512, 1024, 2048, 4096}) {
    const Vec3 end = end_of_stiff_chain([&](const System& system) {
      State state = system.rest_state();
      BackwardEuler stepper(system);
      for (int i = 0; i < steps; ++i) EXPECT_TRUE(stepper.advance(state, 0.4 / steps).ok()) << i;
      return state.y;
    });
    errors.push_back((end - truth).norm());
    std::printf("%d steps: %.3e\n", steps, errors.back());
  }
  EXPECT_LT(errors.front(), 0.02);
  for (std::size_t k = 1; k < errors.size(); ++k)
    EXPECT_NEAR(std::log2(errors[k - 1] / errors[k]), 1.0, 0.1) << k;
}

TEST(BackwardEuler, TakesAStiffRodToItsEquilibriumInLongSteps) {
  const System system = cantilever(1e10);
  State state = system.rest_state();
  BackwardEuler stepper(system);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(stepper.advance(state, 1.0).ok()) << i;
  // Cantilever under its own weight: w L^4 / 8 E I, plus what the chain's half-edges add.
  const double expected = -1000 * M_PI * 25e-6 * 9.81 / (8 * 1e10 * M_PI / 4 * std::pow(5e-3, 4));
  EXPECT_NEAR(state.y[3 * 31 + 2] / expected, 1.0, 5e-3);
  EXPECT_LT(state.y.segment(96, 96).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace tendril
