#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/simulation.h>

#include <utility>

#include "coupled.h"

namespace tendril {
namespace {

using test::coupled_residual;
using test::Everything;
using test::FarSpring;
using test::rod_at;
using test::Seen;
using Says = FarSpring::Says;

/// A far spring that pushes nodes apart where they are nearer than its length, and says so at each state.
struct Bumper : FarSpring {
  /// What it says of states.
  enum class At { nothing, honest, too_little, too_much, wrong_loads };
  Bumper(std::size_t first, std::size_t second, double stiffness, double rest, Says how, At at)
      : FarSpring(first, second, stiffness, rest, how), states(at) {}

  bool acts(const StateView& state) const { return (state.p[b] - state.p[a]).norm() < length; }
  void add(const StateView& state, const Loads& loads) const override {
    if (acts(state)) FarSpring::add(state, loads);
  }
  double energy(const StateView& state) const override {
    return acts(state) ? FarSpring::energy(state) : 0.0;
  }
  Couplings couplings(std::span<const NodeRange> rods) const override {
    const Couplings spring = FarSpring::couplings(rods);
    Couplings all = Couplings::among({a, b});
    if (states != At::nothing)
      all = std::move(all).at_states([this](const StateView& state) { return local(state); });
    if (!spring.derivatives()) return all;
    return std::move(all).with([this, spring](const StateView& state, LoadDerivatives& to) {
      if (acts(state)) spring.derivatives()(state, to);
    });
  }
  LocalCouplings local(const StateView& state) const {
    LocalCouplings here;
    if (states == At::too_much) here.pairs.emplace_back(0, 4);
    if (!acts(state)) return here;
    if (states == At::too_little)
      here.pairs.emplace_back(a, a);
    else
      here.pairs.emplace_back(a, b);
    here.add = [this](const StateView& beside, const Loads& loads) {
      for (int i = 0; i < (states == At::wrong_loads ? 2 : 1); ++i) FarSpring::add(beside, loads);
    };
    return here;
  }

  At states;
};

/// Two clamped rods whose tips swing into bumpers, one after the other, and out again.
System bumpers(Says says, Bumper::At at, bool twist, double reach) {
  Scene scene;
  scene.rods = {rod_at(0, 8, twist), rod_at(0.3, 6, twist)};
  scene.anchors = {{.rod = 0, .node = 0}, {.rod = 1, .node = 6}};
  scene.forces.push_back(std::make_shared<Bumper>(4, 12, 60.0, reach, says, at));
  scene.forces.push_back(std::make_shared<Bumper>(6, 13, 60.0, 0.95 * reach, says, at));
  return System(scene);
}

/// Room for what acts at a state alone serves as well as for all, to the last bit, as it comes and goes.
TEST(LocalCouplings, GiveTheBitsOfThoseNamedThroughout) {
  for (const Says says : {Says::exact, Says::differences})
    for (const bool twist : {false, true}) {
      SCOPED_TRACE(testing::Message() << (says == Says::exact ? "exact" : "differences") << ' ' << twist);
      Eigen::VectorXd end[2];
      long evaluations[2] = {0, 0}, changes = 0;
      for (const bool local : {false, true}) {
        const System system = bumpers(says, local ? Bumper::At::honest : Bumper::At::nothing, twist, 0.28);
        State state = system.rest_state();
        const auto n = 3 * static_cast<Eigen::Index>(system.node_count());
        for (Eigen::Index i = 0; i < 9; ++i) state.y[n + 3 * i + 1] = 0.1 * static_cast<double>(i);
        Simulation simulation(system, state, {.method = Method::rodas, .tolerance = 1e-6});
        bool acted = false;
        simulation.on_progress([&](double) {
          const bool acts =
              (test::at(simulation.state().y, 4) - test::at(simulation.state().y, 12)).norm() < 0.28;
          changes += local && acts != std::exchange(acted, acts);
          return true;
        });
        const Report report = simulation.run(2.0);
        ASSERT_EQ(report.stop, Stop::finished) << report.reason;
        end[local] = simulation.state().y;
        evaluations[local] = static_cast<long>(report.evaluations);
      }
      EXPECT_GE(changes, 2);
      EXPECT_EQ(end[0], end[1]);
      if (says == Says::differences) EXPECT_LT(evaluations[1], evaluations[0]);
    }
}

TEST(LocalCouplings, EnterTheJacobian) {
  for (const Says says : {Says::exact, Says::differences})
    for (const bool twist : {false, true})
      EXPECT_LT(coupled_residual(bumpers(says, Bumper::At::honest, twist, 0.4), 100.0), 3e-5);
  EXPECT_GT(coupled_residual(bumpers(Says::differences, Bumper::At::too_little, false, 0.4), 1.0), 1e-4);
}

/// All of many nodes, or two of them.
struct MayCoupleAll : Everything {
  explicit MayCoupleAll(bool all) : Everything(0, 479, 1.0, 0.5, Says::exact), does(all) {}
  Couplings couplings(std::span<const NodeRange> rods) const override {
    return Everything::couplings(rods).at_states([this, rods](const StateView&) {
      return does ? LocalCouplings{Everything::couplings(rods).pairs(), {}} : LocalCouplings{{{a, b}}, {}};
    });
  }
  bool does;
};

TEST(LocalCouplings, AreRefusedWhereEliminationCannotCarryThoseOfAState) {
  for (const bool all : {false, true}) {
    Scene scene;
    scene.rods.push_back(rod_at(0, 479, false));
    scene.forces = {std::make_shared<MayCoupleAll>(all)};
    const System system(scene);
    Simulation simulation(system, system.rest_state(), {.method = Method::rodas, .tolerance = 1e-3});
    const Report report = simulation.run(1e-3);
    EXPECT_EQ(report.stop == Stop::finished, !all) << report.reason;
    if (all) EXPECT_NE(report.reason.find("couple more nodes"), std::string::npos) << report.reason;
  }
}

/// The automatic choice comes back from implicit steps, and says why.
TEST(LocalCouplings, LeaveTheAutomaticChoiceWithExplicitSteps) {
  Scene scene;
  scene.rods.push_back(rod_at(0, 479, false));
  scene.forces = {std::make_shared<MayCoupleAll>(true)};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-3});
  const Report report = simulation.run(0.01);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(report.method, "Nystrom 5(3)");
  ASSERT_GE(report.switches.size(), 3u);
  EXPECT_NE(report.switches.back().reason.find("couple more nodes"), std::string::npos)
      << report.switches.back().reason;
}

TEST(CheckForce, FindsWhatALocalCouplingLeavesOut) {
  const Seen seen;
  const auto check = [&](Bumper::At at) {
    return check_force(Bumper(1, 7, 5.0, 9.0, Says::differences, at), seen.view());
  };
  const ForceCheck honest = check(Bumper::At::honest);
  EXPECT_TRUE(honest.undeclared.empty());
  EXPECT_EQ(honest.local, 0.0);
  const std::vector<Couplings::Pair> little{{1, 7}, {7, 1}, {7, 7}}, much{{0, 0}, {0, 4}, {4, 0}, {4, 4}};
  EXPECT_EQ(check(Bumper::At::too_little).undeclared, little);
  EXPECT_EQ(check(Bumper::At::too_much).undeclared, much);
  EXPECT_NEAR(check(Bumper::At::wrong_loads).local, 1.0, 1e-3);
}

}  // namespace
}  // namespace tendril
