#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <cmath>

#include "support/rods.h"
#include "support/ties.h"
#include "support/tops.h"

namespace tendril {
namespace {

using test::Tie;
using test::tie_of;
using test::tied;

/// A view on a rod of four nodes and two bodies, all moving.
struct Stirred {
  explicit Stirred(std::uint64_t seed) {
    test::Random random(seed);
    for (int i = 0; i < 4; ++i) {
      p.push_back(Vec3(0.3 * i, 0, 0) + 0.1 * random.in_cube());
      v.push_back(2.0 * random.in_cube());
      t.push_back(random.in_cube().normalized());
    }
    for (int b = 0; b < 2; ++b)
      bodies.push_back({random.in_cube(), test::turned(2.0 * random.in_cube()), random.in_cube(),
                        3.0 * random.in_cube(), 2.0});
  }
  StateView view() const { return {0.3, p, v, t, spin, mass, spin, rods, m, nullptr, bodies}; }
  std::vector<Vec3> p, v, t, m{4, Vec3::Zero()};
  std::vector<double> spin = std::vector<double>(4, 0.0), mass = std::vector<double>(4, 1.0);
  std::vector<NodeRange> rods{{0, 4}};
  std::vector<BodyView> bodies;
};

TEST(CheckForce, HoldsForcesOnBodiesToWhatTheySay) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Stirred state(seed);
    const ForceCheck spring = check_force(tie_of(40.0, 0.0), state.view());
    EXPECT_TRUE(spring.undeclared.empty());
    EXPECT_LT(spring.derivatives, 1e-9);
    EXPECT_LT(spring.energy, 1e-9);
    const ForceCheck damper = check_force(tie_of(40.0, 3.0), state.view());
    EXPECT_TRUE(damper.undeclared.empty());
    EXPECT_LT(damper.derivatives, 1e-9);
    const ForceCheck gravity = check_force(Gravity({0.3, 0, -9.8}), state.view());
    EXPECT_TRUE(gravity.undeclared.empty());
    EXPECT_LT(gravity.energy, 1e-8);
  }
}

TEST(CheckForce, FindsForcesOnBodiesThatDoNotKeepToIt) {
  const Stirred state(1);
  // Without the turn of its body, 7.
  Tie tie = tie_of(40.0, 0.0);
  tie.honest = tie.derives = false;
  const ForceCheck turns = check_force(tie, state.view());
  const std::vector<Couplings::Pair> expected{{2, 7}, {6, 7}, {7, 2}, {7, 6}, {7, 7}};
  EXPECT_EQ(turns.undeclared, expected);
  struct Wrong : Tie {
    explicit Wrong(const Tie& tie) : Tie(tie) {}
    double energy(const StateView& s) const override {
      return Tie::energy(s) + 2.0 * s.bodies[1].rotation(0, 1);
    }
  };
  EXPECT_GT(check_force(Wrong(tie_of(40.0, 0.0)), state.view()).energy, 1e-3);
  struct Short : Tie {
    explicit Short(const Tie& tie) : Tie(tie) {}
    Couplings couplings_with_bodies(std::span<const NodeRange>, std::size_t) const override {
      return Couplings::among({2, 6, 7}).with([](const StateView& s, LoadDerivatives& to) {
        to.add_by_position(7, 7, Mat3::Identity() * s.time);
      });
    }
  };
  EXPECT_GT(check_force(Short(tie_of(40.0, 0.0)), state.view()).derivatives, 1e-3);
}

Vec3 momentum(const System& system, const State& state) {
  const std::vector<double>& mass = system.scene().rods[0].mass;
  const auto n = static_cast<Eigen::Index>(mass.size());
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    sum += mass[static_cast<std::size_t>(i)] * state.y.segment<3>(3 * (n + i));
  for (const BodyView& body : system.bodies(state)) sum += body.mass * body.velocity;
  return sum;
}

Vec3 angular_momentum(const System& system, const State& state) {
  const std::vector<double>& mass = system.scene().rods[0].mass;
  const auto n = static_cast<Eigen::Index>(mass.size());
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    sum +=
        mass[static_cast<std::size_t>(i)] * state.y.segment<3>(3 * i).cross(state.y.segment<3>(3 * (n + i)));
  const std::vector<BodyView> bodies = system.bodies(state);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sum += bodies[b].mass * bodies[b].position.cross(bodies[b].velocity) +
           test::angular_momentum(system.scene().bodies[b], bodies[b]);
  return sum;
}

class Tied : public testing::TestWithParam<Method> {};

TEST_P(Tied, KeepsMomentumAndEnergy) {
  const System system(tied(true, 60.0, 0.0));
  SimulationOptions options;
  options.method = GetParam();
  options.tolerance = 1e-8;
  if (!chooses_steps(GetParam())) options.fixed_step = 1e-4;
  Simulation simulation(system, system.rest_state(), options);
  const Vec3 p = momentum(system, simulation.state());
  const Vec3 l = angular_momentum(system, simulation.state());
  const Report report = simulation.run(0.5);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const Vec3 dp = momentum(system, simulation.state()) - p;
  const Vec3 dl = angular_momentum(system, simulation.state()) - l;
  std::printf("%s: momentum off by %.1e, angular by %.1e, energy by %.1e, %ld evaluations\n",
              report.method.c_str(), dp.norm(), dl.norm(), report.imbalance, report.evaluations);
  EXPECT_LT(dp.norm(), 1e-7 * p.norm());
  EXPECT_LT(dl.norm(), 1e-6 * l.norm());
  EXPECT_LT(std::abs(report.imbalance), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Methods, Tied,
                         testing::Values(Method::cash_karp, Method::rodas, Method::runge_kutta4),
                         [](const auto& method) { return to_string(method.param); });

/// The numbers of all after a time, by a method with its choice of steps.
Eigen::VectorXd after(const System& system, Method method, double time) {
  SimulationOptions options;
  options.method = method;
  options.tolerance = 1e-9;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(time);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_LT(std::abs(report.imbalance), 1e-7);
  const std::vector<BodyView> bodies = system.bodies(simulation.state());
  Eigen::VectorXd all(6 * static_cast<Eigen::Index>(system.node_count()) + 18);
  all << simulation.state().y.head(6 * static_cast<Eigen::Index>(system.node_count())), bodies[1].position,
      bodies[1].velocity, bodies[1].spin, bodies[1].rotation.col(0), bodies[1].rotation.col(1),
      bodies[1].rotation.col(2);
  return all;
}

TEST(TiedBodies, MoveAlikeByExplicitAndImplicitSteps) {
  for (const bool twist : {false, true})
    for (const double damping : {0.0, 0.5}) {
      const System exact(tied(true, 60.0, damping, twist));
      const System differences(tied(false, 60.0, damping, twist));
      const Eigen::VectorXd by_explicit = after(exact, Method::cash_karp, 0.3);
      const double off = (after(exact, Method::rodas, 0.3) - by_explicit).cwiseAbs().maxCoeff();
      const double by_differences =
          (after(differences, Method::rodas, 0.3) - by_explicit).cwiseAbs().maxCoeff();
      std::printf("off by %.1e, and %.1e by differences\n", off, by_differences);
      EXPECT_LT(off, 1e-5);
      EXPECT_LT(by_differences, 1e-5);
    }
}

/// Forces of a time of its own, which implicit steps differentiate too.
struct Shaken : Force {
  void add(const StateView& state, const Loads& loads) const override {
    loads.bodies[0].torque += Vec3(0.1, 0.3, -0.2) * std::sin(4.0 * state.time);
    loads.bodies[0].force += Vec3(1, 0, 2) * std::cos(3.0 * state.time);
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
};

TEST(Rodas, KeepsTheBooksOfBodiesThatAreShaken) {
  Scene scene = tied(true, 60.0, 0.2);
  scene.forces.push_back(std::make_shared<Shaken>());
  const System system(scene);
  const auto run = [&](double tolerance) {
    SimulationOptions options;
    options.method = Method::rodas;
    options.tolerance = tolerance;
    Simulation simulation(system, system.rest_state(), options);
    return simulation.run(0.6);
  };
  const Report report = run(1e-8);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  std::printf("work %.2e, energy off by %.1e, %ld evaluations\n", report.work, report.imbalance,
              report.evaluations);
  EXPECT_GT(std::abs(report.work), 1e-3);
  EXPECT_LT(std::abs(report.imbalance), 1e-6);
}

/// A body hung by its surface on the tip of a clamped rod, by a spring far stiffer than all else: explicit
/// steps would be too dear, and the choice knows.
TEST(AutomaticChoice, TurnsToImplicitStepsWhereABodyIsTiedStiffly) {
  Scene scene = tied(true, 1e9, 1e3);
  scene.anchors.push_back({.rod = 0, .node = 0});
  const auto& tie = static_cast<const Tie&>(*scene.forces[0]);
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  Body& body = scene.bodies[1];
  body.position = scene.rods[0].p[6] - body.rotation * tie.at;
  body.velocity = body.spin = Vec3::Zero();
  const System system(scene);
  const auto run = [&](Method method) {
    SimulationOptions options;
    options.method = method;
    options.work_limit = 200'000;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(0.2);
    std::printf("%s: %ld evaluations, fastest %.1e\n", report.method.c_str(), report.evaluations,
                report.largest_frequency);
    return report;
  };
  EXPECT_EQ(run(Method::cash_karp).stop, Stop::too_stiff);
  const Report report = run(Method::automatic);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NE(report.method.find("RODAS"), std::string::npos);
}

/// Couples a node with an index that may not be there: 7 nodes and two bodies have 11.
struct Reaching : Force {
  explicit Reaching(std::size_t at) : index(at) {}
  void add(const StateView&, const Loads&) const override {}
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::among({0, index}); }
  std::size_t index;
};

TEST(Couplings, RefuseBodiesThatAreNotThere) {
  Scene scene = tied(true, 60.0, 0.0);
  scene.forces[0] = std::make_shared<Reaching>(11);
  EXPECT_EQ(test::place_of_refusal(scene), "forces[0]");
  scene.forces[0] = std::make_shared<Reaching>(10);
  EXPECT_EQ(test::place_of_refusal(scene), "accepted");
}

}  // namespace
}  // namespace tendril
