#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include "dynamics/scene/model.h"
#include "dynamics/steppers/stiff_solver.h"
#include "support/order.h"
#include "support/rods.h"
#include "support/springs.h"

namespace tendril {
namespace {

using test::Aligning;
using test::FarSpring;
using Says = FarSpring::Says;

Rod rod_at(double y, int edges, bool twist) {
  std::vector<Vec3> p = test::straight(edges, 1.0);
  for (Vec3& point : p) point.y() = y;
  return make_rod(p, orientation_towards(p, Vec3(0, 0.5, 1), 0.1), {1e5, 1e5 / 3, 1000},
                  elliptic_section(0.02, twist ? 0.012 : 0.02));
}

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

/// What solves (s - J) U = r, put back with J U by central differences of the equations, over the size of J
/// U.
double coupled_residual(const System& system, double s) {
  const Model& model = model_of(system);
  test::Random random(5);
  State state = test::stirred(system, random, 0.02);
  const auto n = static_cast<Eigen::Index>(3 * model.nodes);
  for (Eigen::Index i = 0; i < n; ++i) state.y[n + i] = random.uniform(-1, 1);
  const auto work = system.make_workspace();
  Eigen::VectorXd rate, up, down, r(state.y.size()), u;
  if (!system.rebase(state, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) return 1.0;
  const auto solver = make_stiff_solver(system, *work);
  if (solver->differentiate(state, rate) < 0 || !solver->factor(s)) return 1.0;
  for (double& x : r) x = random.uniform(-1, 1);
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    if (model.holds_position(i)) r.segment<3>(at).setZero(), r.segment<3>(n + at).setZero();
    if (!model.has_twist(i) || !model.holds_frame(i)) continue;
    r[model.theta_begin() + model.twist_index[i]] = r[model.spin_begin() + model.twist_index[i]] = 0.0;
  }
  solver->solve(s, r, u);
  const double h = 1e-6 / u.cwiseAbs().maxCoeff();
  if (!system.derivative(state, state.time, state.y + h * u, up, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y - h * u, down, *work).ok()) return 1.0;
  const Eigen::VectorXd turned = (up - down) / (2 * h);
  return (s * u - turned - r).head(u.size() - 1).cwiseAbs().maxCoeff() /
         turned.head(u.size() - 1).cwiseAbs().maxCoeff();
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

struct Everything : FarSpring {
  using FarSpring::FarSpring;
  Couplings couplings(std::span<const NodeRange> rods) const override {
    std::vector<std::size_t> nodes(rods[0].count);
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = i;
    return Couplings::among(nodes);
  }
};

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
  EXPECT_EQ(report.method, "Cash-Karp 4(5)");
  ASSERT_EQ(report.switches.size(), 1u);
  EXPECT_NE(report.switches[0].reason.find("forces[0]"), std::string::npos) << report.switches[0].reason;
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

/// Two stirred rods and what forces see of them.
struct Seen {
  Seen() {
    test::Random random(3);
    for (std::size_t i = 0; i < 9; ++i) {
      p.push_back(Vec3(0.3 * static_cast<double>(i), 0, 0) + 0.1 * random.in_cube());
      v.push_back(2.0 * random.in_cube());
      t.push_back(random.in_cube().normalized());
      m.push_back(t.back().cross(random.in_cube()).normalized());
    }
  }
  StateView view() const { return {0.37, p, v, t, spin, mass, width, rods, m}; }
  std::vector<Vec3> p, v, t, m;
  std::vector<double> spin = std::vector<double>(9, 0.1), mass = std::vector<double>(9, 1.0),
                      width = std::vector<double>(9, 0.02);
  std::vector<NodeRange> rods{{0, 5}, {5, 4}};
};

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
  EXPECT_EQ(report.method, "Cash-Karp 4(5)");
  ASSERT_EQ(report.switches.size(), 3u);
  EXPECT_NE(report.switches[2].reason.find("couple more nodes"), std::string::npos)
      << report.switches[2].reason;
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
