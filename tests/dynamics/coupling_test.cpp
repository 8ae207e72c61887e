#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include "coupled.h"
#include "support/order.h"

namespace tendril {
namespace {

using test::Aligning;
using test::coupled_residual;
using test::Everything;
using test::FarSpring;
using test::rod_at;
using test::Seen;
using Says = FarSpring::Says;

/// A free rod with a spring between its ends, which buckles it.
System bow(Says says, bool twist) {
  Scene scene;
  scene.rods.push_back(rod_at(0, 8, twist));
  scene.forces.push_back(std::make_shared<FarSpring>(0, 8, 40.0, 0.5, says));
  return System(scene);
}

/// Two clamped rods side by side with springs between their nodes, one of them across their halves.
System pair_of_rods(Says says, bool twist) {
  Scene scene;
  scene.rods = {rod_at(0, 8, twist), rod_at(0.3, 6, twist)};
  scene.anchors = {{.rod = 0, .node = 0}, {.rod = 1, .node = 6}};
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  scene.forces.push_back(std::make_shared<FarSpring>(8, 10, 60.0, 0.2, says));
  scene.forces.push_back(std::make_shared<FarSpring>(4, 12, 30.0, 0.1, says));
  if (twist) scene.forces.push_back(std::make_shared<Aligning>(5, 11, 0.0005));
  return System(scene);
}

State moving(const System& system, double speed) {
  State state = system.rest_state();
  test::Random random(31);
  const auto n = 3 * static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 0; i < n; ++i) state.y[n + i] = random.uniform(-speed, speed);
  const auto work = system.make_workspace();
  EXPECT_TRUE(system.rebase(state, *work).ok());
  return state;
}

TEST(FarForce, KeepsTheOrderOfRodas) {
  for (const Says says : {Says::exact, Says::differences})
    for (const bool twist : {false, true}) {
      SCOPED_TRACE(testing::Message() << (says == Says::exact ? "exact" : "differences") << ' ' << twist);
      const System one = bow(says, twist);
      EXPECT_GE(test::order_of(one, moving(one, 0.2), 0.06, 100), 3.8);
      const System two = pair_of_rods(says, twist);
      EXPECT_GE(test::order_of(two, moving(two, 0.2), 0.06, 100), 3.8);
    }
}

/// What the test above would see of couplings that are not carried.
TEST(FarForce, LosesTheOrderWhereItsCouplingsAreNotSaid) {
  const System one = bow(Says::first_node_alone, false);
  EXPECT_LT(test::order_of(one, moving(one, 0.2), 0.06, 100), 3.5);
}

/// A tree: the spring ends at a child's first node, which its parent carries, and beside it.
System tree(Says says, std::size_t at) {
  Scene scene;
  std::vector<Vec3> p;
  for (int i = 0; i <= 4; ++i) p.emplace_back(0.5, 0.2 * i, 0);
  scene.rods = {
      rod_at(0, 8, true),
      make_rod(p, orientation_towards(p, Vec3(0.3, 0, 1), 0.1), {1e5, 1e5 / 3, 1000}, circular_section(0.02)),
      rod_at(1.0, 6, true)};
  scene.joints.push_back({.parent = 0, .node = 4, .child = 1});
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<FarSpring>(at, 17, 50.0, 0.3, says));
  if (says == Says::differences) scene.forces.push_back(std::make_shared<Aligning>(at, 18, 0.02));
  return System(scene);
}

TEST(FarForce, EntersTheJacobian) {
  for (const double s : {1.0, 100.0})
    for (const Says says : {Says::exact, Says::differences}) {
      SCOPED_TRACE(testing::Message() << s << (says == Says::exact ? " exact" : " differences"));
      for (const bool twist : {false, true}) {
        EXPECT_LT(coupled_residual(bow(says, twist), s), 3e-5);
        EXPECT_LT(coupled_residual(pair_of_rods(says, twist), s), 3e-5);
      }
      for (const std::size_t at : {9u, 10u, 2u}) EXPECT_LT(coupled_residual(tree(says, at), s), 3e-5) << at;
    }
  EXPECT_GT(coupled_residual(bow(Says::first_node_alone, false), 1.0), 1e-3);
}

/// The place at which a call refuses its input; empty where it does not.
template <typename Call>
std::string refused_at(const Call& call) {
  try {
    call();
  } catch (const InvalidInput& error) {
    return error.place();
  }
  return {};
}

TEST(FarForce, IsRefusedByNameWhereEliminationCannotCarryIt) {
  Scene scene;
  scene.rods.push_back(rod_at(0, 599, false));
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -9.81)),
                  std::make_shared<FarSpring>(0, 599, 1.0, 0.5, Says::differences),
                  std::make_shared<Everything>(0, 599, 1.0, 0.5, Says::exact)};
  const System system(scene);
  const auto run_by = [&](Method method) {
    return refused_at([&] { Simulation(system, system.rest_state(), {.method = method}); });
  };
  EXPECT_EQ(run_by(Method::rodas), "forces[2]");
  EXPECT_EQ(run_by(Method::cash_karp), "");
  EXPECT_EQ(refused_at([&] { Rodas rodas(system); }), "forces[2]");
}

TEST(FarForce, LeavesTheAutomaticChoiceWithExplicitSteps) {
  Scene scene;
  scene.rods.push_back(rod_at(0, 599, false));
  scene.forces = {std::make_shared<Everything>(0, 599, 1.0, 0.5, Says::exact)};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-3});
  const Report report = simulation.run(1e-3);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(report.method, "Nystrom 5(3)");
  ASSERT_EQ(report.switches.size(), 2u);
  EXPECT_NE(report.switches[1].reason.find("forces[0]"), std::string::npos) << report.switches[1].reason;
}

TEST(FarForce, IsRefusedWhereItNamesWhatIsNotThere) {
  Scene scene;
  scene.rods.push_back(rod_at(0, 4, false));
  scene.forces = {std::make_shared<FarSpring>(0, 5, 1.0, 0.5, Says::exact)};
  EXPECT_EQ(test::place_of_refusal(scene), "forces[0]");
}

TEST(FarForce, IsRefusedWhereItDerivesWhatItDoesNotName) {
  const System system = bow(Says::exact_of_first_node_alone, false);
  Rodas rodas(system);
  State state = system.rest_state();
  EXPECT_EQ(refused_at([&] { (void)rodas.advance(state, 1e-3); }), "forces[0]");
}

TEST(FarForce, BowsARodInEquilibriumToo) {
  Scene scene = bow(Says::exact, true).scene();
  scene.anchors.push_back({.rod = 0, .node = 4});
  const System system(scene);
  const Equilibrium at = find_equilibrium(system, moving(system, 0.0), {.work_limit = 400});
  std::printf("bow at rest: %s after %ld iterations, %s\n", to_string(at.balance), at.iterations,
              to_string(at.stability.kind));
  EXPECT_EQ(at.balance, Balance::converged) << at.reason;
  EXPECT_LT(at.residual, 1e-6);
  EXPECT_LT((test::at(at.state.y, 8) - test::at(at.state.y, 0)).norm(), 0.95);
}

TEST(CheckForce, PassesHonestForces) {
  const Seen seen;
  WindOptions wind;
  wind.mean = Vec3(3, 1, -0.5);
  wind.gust = 0.6;
  const auto check = [&](const Force& force) {
    const ForceCheck found = check_force(force, seen.view());
    EXPECT_TRUE(found.undeclared.empty());
    EXPECT_LT(found.derivatives, 1e-7);
    EXPECT_LT(found.energy, 1e-7);
  };
  check(Wind(wind));
  check(Gravity(Vec3(1, 2, 3)));
  check(PullTowards(1, 2, Vec3(1, 2, 3), 40.0));
  check(PointLoad(PointLoad::Kind::torque, 1, 2, Vec3(1, 2, 3), Signal::constant(1)));
  check(FarSpring(1, 7, 5.0, 0.4, Says::exact));
  check(FarSpring(1, 7, 5.0, 0.4, Says::differences));
  check(Aligning(2, 8, 3.0));
}

struct WrongSlope : FarSpring {
  using FarSpring::FarSpring;
  Couplings couplings(std::span<const NodeRange>) const override {
    return Couplings::among({a, b}).with(
        [this](const StateView&, LoadDerivatives& to) { to.add_by_position(a, b, k * Mat3::Identity()); });
  }
  double energy(const StateView& state) const override { return 2 * FarSpring::energy(state); }
};

TEST(CheckForce, FindsWhatIsNotAsAForceSays) {
  const Seen seen;
  const ForceCheck lie = check_force(FarSpring(1, 7, 5.0, 0.4, Says::first_node_alone), seen.view());
  const std::vector<Couplings::Pair> expected{{1, 7}, {7, 1}, {7, 7}};
  EXPECT_EQ(lie.undeclared, expected);
  const ForceCheck wrong = check_force(WrongSlope(1, 7, 5.0, 0.4, Says::exact), seen.view());
  EXPECT_TRUE(wrong.undeclared.empty());
  EXPECT_GT(wrong.derivatives, 0.1);
  EXPECT_NEAR(wrong.energy, 1.0, 0.5);
}

}  // namespace
}  // namespace tendril
