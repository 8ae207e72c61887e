#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <algorithm>

#include "support/rods.h"

namespace tendril {
namespace {

System swinging(int nodes, double young) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(nodes - 1, young, 5e-3));
  scene.rods[0].mass_damping = 0.5;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  return System(scene);
}

Report run(const System& system, Method method, double until, Eigen::VectorXd* end = nullptr,
           double tolerance = 1e-3) {
  SimulationOptions options;
  options.method = method;
  options.tolerance = tolerance;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(until);
  if (end) *end = simulation.state().y.head(3 * static_cast<Eigen::Index>(system.node_count()));
  return report;
}

TEST(AutomaticChoice, StaysExplicitOnASoftRod) {
  const Report report = run(swinging(32, 1e4), Method::automatic, 1.0);
  ASSERT_EQ(report.stop, Stop::finished);
  EXPECT_EQ(report.method, "Nystrom 5(3)");
  ASSERT_EQ(report.switches.size(), 2u);
  for (const Switch& entry : report.switches) EXPECT_FALSE(entry.reason.empty());
}

struct Soft {
  double young, tolerance, until;
};

TEST(AutomaticChoice, TakesTheVeryStepsOfCashKarpWhereAccuracyAloneShortensThem) {
  for (const auto& [young, tolerance, until] : {Soft{1e3, 1e-5, 1.0}, Soft{1e3, 1e-6, 1.0}}) {
    const System system = swinging(32, young);
    Eigen::VectorXd chosen;
    Eigen::VectorXd told;
    const Report report = run(system, Method::automatic, until, &chosen, tolerance);
    const Report by_name = run(system, Method::cash_karp, until, &told, tolerance);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_EQ(report.switches.size(), 1u) << young;
    EXPECT_EQ(chosen, told) << young;
    EXPECT_EQ(report.accepted, by_name.accepted);
    EXPECT_EQ(report.evaluations, by_name.evaluations);
    EXPECT_EQ(report.last.total(), by_name.last.total());
  }
}

TEST(AutomaticChoice, TurnsToNystromWhereTheGuardShortensCashKarpsSteps) {
  for (const auto& [young, tolerance, until] :
       {Soft{1e4, 1e-3, 1.0}, Soft{1e5, 1e-3, 1.0}, Soft{1e5, 1e-4, 1.5}}) {
    const System system = swinging(32, young);
    Eigen::VectorXd chosen;
    Eigen::VectorXd reference;
    const Report report = run(system, Method::automatic, until, &chosen, tolerance);
    const Report by_name = run(system, Method::cash_karp, until, nullptr, tolerance);
    ASSERT_EQ(run(system, Method::cash_karp, until, &reference, 1e-9).stop, Stop::finished);
    const double error = (chosen - reference).norm() / std::sqrt(32.0);
    std::printf("E %.0e at %.0e: %ld evaluations, %ld by Cash-Karp, error %.1e\n", young, tolerance,
                report.evaluations, by_name.evaluations, error);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    ASSERT_GE(report.switches.size(), 2u);
    EXPECT_EQ(report.switches[0].to, "Cash-Karp 4(5)");
    EXPECT_EQ(report.switches[1].to, "Nystrom 5(3)");
    EXPECT_EQ(report.method, "Nystrom 5(3)");
    EXPECT_LT(report.evaluations, 0.65 * static_cast<double>(by_name.evaluations));
    EXPECT_LT(error, 5.0 * tolerance);
  }
}

/// A rod that goes on ringing in all its modes.
Report ring(Method method, double until) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e4, 5e-3));
  scene.anchors.push_back({.rod = 0, .node = 0});
  const System system(scene);
  State start = system.rest_state();
  for (int i = 1; i < 5; ++i) start.y[3 * i] *= i % 2 == 0 ? 1.02 : 0.98;
  Simulation simulation(system, start, {.method = method, .tolerance = 1e-3});
  return simulation.run(until);
}

TEST(NystromSteps, AreShortenedWhereTheyWouldLoseEnergy) {
  const Report report = ring(Method::nystrom, 30.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  std::printf("drift %.1e, imbalance %.1e, %ld steps\n", report.drift, report.imbalance, report.accepted);
  EXPECT_LT(report.drift, 10e-3);
}

TEST(AutomaticChoice, ComesBackToCashKarpWhereNystromsStepsLoseEnergy) {
  const Report report = ring(Method::automatic, 30.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  std::printf("drift %.1e, imbalance %.1e, %ld steps\n", report.drift, report.imbalance, report.accepted);
  EXPECT_EQ(report.method, "Cash-Karp 4(5)");
  EXPECT_TRUE(std::any_of(report.switches.begin(), report.switches.end(),
                          [](const Switch& entry) { return entry.reason == "steps lose energy"; }));
  EXPECT_LT(report.drift, 50e-3);
}

// At the cap what is fast is seen by the error estimate: what implicit steps could do is found out by trying,
// ever more seldom.
TEST(AutomaticChoice, TriesImplicitStepsWhereNystromsStayAtTheCap) {
  Scene scene = swinging(9, 1e7).scene();
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  const Report report = run(system, Method::automatic, 3.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const auto trials = std::count_if(report.switches.begin(), report.switches.end(), [](const Switch& entry) {
    return entry.reason == "explicit steps stay at the guard's cap, or are tried in vain there";
  });
  EXPECT_GE(trials, 1);
  EXPECT_LE(trials, 5);
}

TEST(AutomaticChoice, TakesImplicitStepsAtOnceWhereViscosityIsStrong) {
  Scene scene = swinging(32, 1e7).scene();
  scene.rods[0].viscosity = 10.0;
  const System system(scene);
  const Report report = run(system, Method::automatic, 5.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(report.switches.size(), 2u);
  EXPECT_EQ(report.switches[1].time, 0.0);
  EXPECT_EQ(report.method, "RODAS 4(3)");
  EXPECT_LT(report.evaluations, 5000);
}

TEST(AutomaticChoice, LooksAgainSoonAfterAStartInDoubt) {
  const Report report = run(swinging(32, 1e6), Method::automatic, 1.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(report.switches.size(), 3u);
  EXPECT_EQ(report.switches[1].to, "Nystrom 5(3)");
  EXPECT_GT(report.switches[2].time, 0.0);
  EXPECT_LT(report.switches[2].time, 0.05);
  EXPECT_EQ(report.method, "RODAS 4(3)");
}

// What decays at the cap spoils the error estimate of explicit steps: by it they are as long as accuracy
// allows.
TEST(AutomaticChoice, TriesImplicitStepsWhereExplicitOnesStayAtTheCap) {
  for (const auto& [viscosity, most] : {std::pair(2e-3, 1.1), {4e-3, 0.5}, {8e-3, 0.3}}) {
    Scene scene = swinging(24, 1e6).scene();
    scene.rods[0].viscosity = viscosity;
    const System system(scene);
    Eigen::VectorXd chosen;
    Eigen::VectorXd told;
    const Report report = run(system, Method::automatic, 3.0, &chosen, 1e-4);
    const Report by_name = run(system, Method::cash_karp, 3.0, &told, 1e-4);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    ASSERT_EQ(by_name.stop, Stop::finished) << by_name.reason;
    std::printf("viscosity %g: %ld evaluations, %ld by Cash-Karp\n", viscosity, report.evaluations,
                by_name.evaluations);
    EXPECT_GE(report.switches.size(), 2u);
    EXPECT_LT(static_cast<double>(report.evaluations), most * static_cast<double>(by_name.evaluations));
    EXPECT_LT((chosen - told).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(AutomaticChoice, IsTheDefault) {
  const System system = swinging(32, 1e8);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-3});
  const Report report = simulation.run(0.1);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(report.switches.size(), 3u);
  EXPECT_EQ(report.switches[0].to, "Cash-Karp 4(5)");
  EXPECT_EQ(report.switches[1].to, "Nystrom 5(3)");
  EXPECT_EQ(report.switches[2].to, "RODAS 4(3)");
  EXPECT_EQ(report.method, "RODAS 4(3)");
}

TEST(AutomaticChoice, TurnsImplicitOnStiffRodsAndEndsRight) {
  for (const double young : {1e8, 1e10}) {
    const System system = swinging(32, young);
    Eigen::VectorXd end;
    Eigen::VectorXd reference;
    const Report report = run(system, Method::automatic, 0.3, &end);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    ASSERT_EQ(report.switches.size(), 2u);
    EXPECT_EQ(report.switches[1].time, 0.0);
    EXPECT_EQ(report.method, "RODAS 4(3)");
    EXPECT_LT(report.accepted, 400);
    ASSERT_EQ(run(system, Method::rodas, 0.3, &reference, 1e-6).stop, Stop::finished);
    const double error = (end - reference).norm() / std::sqrt(32.0);
    std::printf("automatic, E %.0e: %ld steps, %zu entries in the book, error %.1e; %s\n", young,
                report.accepted, report.switches.size(), error, report.switches.back().reason.c_str());
    EXPECT_LT(error, 1e-3);
  }
}

// Where a step is tried in vain again and again, the ratio of the steps that hold says nothing about the
// next.
TEST(StiffControl, RecoversFromStepsTriedInVain) {
  Scene scene = swinging(64, 1e6).scene();
  for (std::size_t i = 1; i < scene.rods[0].mass.size(); i += 2) scene.rods[0].mass[i] /= 1e6;
  const System system(scene);
  Eigen::VectorXd end;
  Eigen::VectorXd reference;
  const Report report = run(system, Method::rodas, 1.0, &end, 1e-3);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_EQ(run(system, Method::rodas, 1.0, &reference, 1e-5).stop, Stop::finished);
  const double error = (end - reference).norm() / 8.0;
  std::printf("masses 1e6 apart: %ld steps, %ld in vain, error %.1e\n", report.accepted, report.rejected,
              error);
  EXPECT_LT(report.accepted, 1000);
  EXPECT_LT(error, 1e-2);
}

/// A spring on the tip whose stiffness comes and goes with time.
struct Comes : Force {
  void add(const StateView& state, const Loads& loads) const override {
    const double k = state.time < 0.2 || state.time >= 0.4 ? 0.0 : 1e7;
    loads.force[3] -= k * (state.p[3] - Vec3(1, 0, 0));
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::within(0); }
  std::vector<double> breaks() const override { return {0.2, 0.4}; }
};

TEST(AutomaticChoice, SwitchesBothWays) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(3, 2e3, 2e-2));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -1)));
  scene.forces.push_back(std::make_shared<Comes>());
  const System system(scene);
  const Report report = run(system, Method::automatic, 1.5, nullptr, 1e-3);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  for (const Switch& entry : report.switches)
    std::printf("  at %.3f %s: %s\n", entry.time, entry.to.c_str(), entry.reason.c_str());
  const auto turned = [&](const char* to) {
    return std::any_of(report.switches.begin(), report.switches.end(),
                       [&](const Switch& entry) { return entry.to == to; });
  };
  EXPECT_TRUE(turned("RODAS 4(3)"));
  EXPECT_NE(report.method, "RODAS 4(3)");
}

}  // namespace
}  // namespace tendril
