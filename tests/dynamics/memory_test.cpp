#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/simulation.h>

#include <thread>

#include "support/rods.h"

namespace tendril {
namespace {

Scene swing(std::shared_ptr<const Force> force) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -9.81)), std::move(force)};
  return scene;
}

SimulationOptions by(Method method) {
  SimulationOptions options;
  options.method = method;
  if (!chooses_steps(method)) options.fixed_step = 5e-5;
  return options;
}

/// Counts how often it was told, and when.
struct Counting : Force {
  struct Memory : ForceMemory {
    int calls = 0;
    double time = 0.0;
  };
  void add(const StateView& state, const Loads&) const override {
    const auto* memory = static_cast<const Memory*>(state.memory);
    if (memory && state.time < memory->time) throw std::logic_error("told of a later time");
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override {
    auto next = std::make_shared<Memory>();
    next->time = state.time;
    next->calls = before ? static_cast<const Memory&>(*before).calls + 1 : 1;
    return next;
  }
};
const Counting::Memory& counted(const State& state) {
  return static_cast<const Counting::Memory&>(*state.memory.at(1));
}

class Remembering : public testing::TestWithParam<Method> {};

TEST_P(Remembering, HappensOnceAtTheStartAndAfterEachAcceptedStep) {
  const System system(swing(std::make_shared<Counting>()));
  SimulationOptions options = by(GetParam());
  // A first step far too long is tried in vain.
  if (chooses_steps(GetParam())) options.first_step = 0.5;
  options.largest_step = 0.5;
  Simulation simulation(system, system.rest_state(), options);
  EXPECT_EQ(counted(simulation.state()).calls, 1);
  Report report = simulation.run(0.02);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(counted(simulation.state()).calls, 1 + report.accepted);
  EXPECT_EQ(counted(simulation.state()).time, report.time);
  report = simulation.run(0.03);
  EXPECT_EQ(counted(simulation.state()).calls, 1 + report.accepted);
  if (GetParam() == Method::rodas) EXPECT_GT(report.rejected, 0);
}

/// A node dragged by a spring to an anchor on the ground that follows where the spring is stretched too far:
/// what a stick-slip contact does.
struct Dragged : Force {
  struct Memory : ForceMemory {
    explicit Memory(const Vec3& at) : anchor(at) {}
    Vec3 anchor;
  };
  static constexpr double kStiffness = 2.0, kLongest = 0.02;
  Vec3 stretch(const StateView& state) const {
    if (!state.memory) return Vec3::Zero();
    return state.p[6] - static_cast<const Memory*>(state.memory)->anchor;
  }
  void add(const StateView& state, const Loads& loads) const override {
    loads.force[6] -= kStiffness * stretch(state);
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::among({6}); }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return true; }
  double energy(const StateView& state) const override {
    return 0.5 * kStiffness * stretch(state).squaredNorm();
  }
  std::shared_ptr<const ForceMemory> remember(
      const StateView& state, const std::shared_ptr<const ForceMemory>& before) const override {
    if (!before) return std::make_shared<Memory>(state.p[6]);
    const Vec3 d = stretch(state);
    if (d.norm() <= kLongest) return before;
    return std::make_shared<Memory>(state.p[6] - kLongest * d.normalized());
  }
};

TEST_P(Remembering, CountsAsWorkWhatItTakes) {
  const System system(swing(std::make_shared<Dragged>()));
  SimulationOptions options = by(GetParam());
  options.tolerance = 1e-7;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(0.3);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const auto& memory = static_cast<const Dragged::Memory&>(*simulation.state().memory.at(1));
  EXPECT_GT((memory.anchor - Vec3(1, 0, 0)).norm(), 0.05);
  EXPECT_LT(report.work, -1e-4);
  std::printf("%s: slipped by %.3f, work %.2e, imbalance %.1e\n", report.method.c_str(),
              (memory.anchor - Vec3(1, 0, 0)).norm(), report.work, report.imbalance);
  EXPECT_LT(std::abs(report.imbalance), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Methods, Remembering,
                         testing::Values(Method::cash_karp, Method::rodas, Method::automatic, Method::verlet,
                                         Method::runge_kutta4, Method::nystrom),
                         [](const auto& at) { return std::string(to_string(at.param)); });

TEST(Memory, IsEachRunsOwn) {
  const System system(swing(std::make_shared<Dragged>()));
  const auto end = [&](double speed) {
    State start = system.rest_state();
    start.y[3 * 7 + 3 * 6 + 1] = speed;
    Simulation simulation(system, start);
    simulation.run(0.2);
    return simulation.state().y;
  };
  const Eigen::VectorXd alone[2] = {end(0.0), end(1.0)};
  Eigen::VectorXd together[2];
  std::thread first([&] { together[0] = end(0.0); });
  std::thread second([&] { together[1] = end(1.0); });
  first.join();
  second.join();
  EXPECT_EQ(together[0], alone[0]);
  EXPECT_EQ(together[1], alone[1]);
  EXPECT_NE(alone[0], alone[1]);
}

/// A floor that pushes by what is left of the gap and refuses to be passed.
struct Floor : Force {
  static constexpr double kHeight = -0.1, kReach = 0.02, kStiffness = 50.0;
  void add(const StateView& state, const Loads& loads) const override {
    for (std::size_t i = 0; i < state.p.size(); ++i) {
      const double gap = state.p[i].z() - kHeight;
      if (gap <= 0.0)
        loads.refuse(i);
      else if (gap < kReach)
        loads.force[i].z() += kStiffness * (kReach - gap) * (kReach - gap) / gap;
    }
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::within(0); }
};

TEST(Refusal, RejectsTheStepThatComesThere) {
  const System system(swing(std::make_shared<Floor>()));
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    SimulationOptions options;
    options.method = method;
    options.tolerance = 1e-2;
    Simulation simulation(system, system.rest_state(), options);
    double lowest = 1.0;
    simulation.on_progress([&](double) {
      for (std::size_t i = 0; i < 7; ++i)
        lowest = std::min(lowest, test::at(simulation.state().y, i).z() - Floor::kHeight);
      return true;
    });
    const Report report = simulation.run(0.4);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_GT(lowest, 0.0);
    EXPECT_LT(lowest, Floor::kReach);
    EXPECT_GT(report.rejected, 0);
  }
}

TEST(Refusal, StopsFixedStepsByName) {
  const System system(swing(std::make_shared<Floor>()));
  State start = system.rest_state();
  for (Eigen::Index i = 1; i < 7; ++i) start.y[21 + 3 * i + 2] = -100.0;
  Simulation simulation(system, start, {.method = Method::verlet, .fixed_step = 2e-3});
  const Report report = simulation.run(0.1);
  EXPECT_EQ(report.stop, Stop::not_evaluable);
  EXPECT_NE(report.reason.find("rod 0 node 1: a force refuses the state"), std::string::npos)
      << report.reason;
}

/// Throws back what falls below a height, with half its speed.
struct Bounce : Follower {
  explicit Bounce(Simulation& of) : simulation(of) {}
  void follow(double, std::span<const CurvePair>) override {
    const Eigen::VectorXd& y = simulation.state().y;
    if (y[2] > 0.0 || y[8] >= 0.0) return;
    ++bounces;
    simulation.change([](State& state) {
      for (const Eigen::Index k : {8, 11}) state.y[k] *= -0.5;
    });
  }
  Simulation& simulation;
  int bounces = 0;
};

class Changing : public testing::TestWithParam<Method> {};

TEST_P(Changing, BooksWhatAnImpactTakes) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(1, 1e4, 0.02));
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -10))};
  const System system(scene);
  State start = system.rest_state();
  start.y[2] = start.y[5] = 1.25;
  SimulationOptions options = by(GetParam());
  if (options.fixed_step) options.fixed_step = 1e-4;
  options.largest_step = 1e-3;
  Simulation simulation(system, start, options);
  Bounce bounce(simulation);
  simulation.add(bounce, Simulation::When::accepted_step);
  const Report report = simulation.run(0.8);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(bounce.bounces, 1);
  const double mass = 2 * scene.rods[0].mass[0];
  // Falls for 0.5 to a speed of 5, leaves at 2.5.
  EXPECT_NEAR(report.changed, -0.5 * mass * (25 - 6.25), 0.01 * mass * 25);
  EXPECT_EQ(report.work, report.changed);
  EXPECT_NEAR(simulation.state().y[2], 2.5 * 0.3 - 5 * 0.09, 0.01);
  EXPECT_LT(std::abs(report.imbalance),
            GetParam() == Method::explicit_euler || GetParam() == Method::backward_euler ? 1e-2 : 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Methods, Changing,
                         testing::Values(Method::cash_karp, Method::rodas, Method::automatic, Method::verlet,
                                         Method::runge_kutta4, Method::explicit_euler,
                                         Method::backward_euler),
                         [](const auto& at) { return std::string(to_string(at.param)); });

class ChangingFixedSteps : public testing::TestWithParam<Method> {};

/// Fixed steps after a change are those of a run begun at the changed state.
TEST_P(ChangingFixedSteps, BeginsTheStepperAnew) {
  Scene scene = swing(std::make_shared<Counting>());
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  const auto push = [&](State& state) {
    state.y[42 + 6] += 0.3;  // the tip's director
    state.y[21 + 19] += 0.5;
  };
  Simulation whole(system, system.rest_state(), by(GetParam()));
  whole.run(0.01);
  whole.change(push);
  Simulation rest(system, whole.state(), by(GetParam()));
  whole.run(0.02);
  rest.run(0.02);
  const Eigen::Index last = whole.state().y.size() - 1;
  EXPECT_EQ(whole.state().y.head(last), rest.state().y.head(last));
}

INSTANTIATE_TEST_SUITE_P(Methods, ChangingFixedSteps,
                         testing::Values(Method::verlet, Method::runge_kutta4, Method::explicit_euler,
                                         Method::backward_euler),
                         [](const auto& at) { return std::string(to_string(at.param)); });

TEST(Change, MakesRodasForgetWhereOnlyDirectorsTurn) {
  Scene scene = swing(std::make_shared<Counting>());
  scene.rods[0] = make_rod(scene.rods[0].p, scene.rods[0].q, {1e5, 4e4, 1000}, elliptic_section(0.02, 0.01));
  const System system(scene);
  const auto work = system.make_workspace();
  Rodas kept(system), fresh(system);
  State state = system.rest_state();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(kept.advance(state, 1e-3).ok());
  state.y[42 + 6] += 0.3;
  ASSERT_TRUE(system.rebase(state, *work).ok());
  kept.restart();
  State other = state;
  ASSERT_TRUE(kept.advance(state, 1e-3).ok());
  ASSERT_TRUE(fresh.advance(other, 1e-3).ok());
  EXPECT_EQ(state.y, other.y);
}

TEST(Change, IsRefusedWhereItCannotGoOn) {
  const System system(swing(std::make_shared<Floor>()));
  Simulation simulation(system, system.rest_state());
  simulation.run(0.01);
  const State before = simulation.state();
  EXPECT_THROW(simulation.change([](State& state) { state.time += 1; }), InvalidInput);
  EXPECT_THROW(simulation.change([](State& state) { state.y.conservativeResize(3); }), InvalidInput);
  EXPECT_THROW(simulation.change([](State& state) { state.y[18] = std::nan(""); }), InvalidInput);
  EXPECT_THROW(simulation.change([](State& state) { state.y[20] = -1.0; }), InvalidInput);
  EXPECT_THROW(simulation.change([](State& state) { state.y.segment<3>(18) = state.y.segment<3>(15); }),
               InvalidInput);
  EXPECT_EQ(simulation.state().y, before.y);
  simulation.change([](State& state) { state.y[0] = 5.0; });  // held by its anchor
  EXPECT_EQ(simulation.state().y, before.y);
}

}  // namespace
}  // namespace tendril
