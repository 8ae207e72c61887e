#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"
#include "support/tops.h"

namespace tendril {
namespace {

Mat3 cross(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A spring and a damper between a node and a point of a body's matter.
struct Tie : Force {
  std::size_t node = 0, body = 0;
  Vec3 at = Vec3::Zero();  ///< in the body's axes
  double stiffness = 0.0, damping = 0.0;
  bool derives = true, honest = true;

  /// What pulls on the body, at which arm.
  struct Pull {
    Vec3 arm, stretch, force;
  };
  Pull pull(const StateView& state) const {
    const BodyView& b = state.bodies[body];
    const Vec3 arm = b.rotation * at;
    const Vec3 stretch = b.position + arm - state.p[node];
    const Vec3 rate = b.velocity_at(b.position + arm) - state.v[node];
    return {arm, stretch, -stiffness * stretch - damping * rate};
  }
  void add(const StateView& state, const Loads& loads) const override {
    const Pull f = pull(state);
    loads.force[node] -= f.force;
    loads.bodies[body].add_at(state.bodies[body].position + f.arm, f.force, state.bodies[body].position);
  }
  Couplings couplings(std::span<const NodeRange>) const override {
    throw std::logic_error("asked without the number of bodies");
  }
  Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const override {
    EXPECT_LT(body, bodies);
    const std::size_t place = rods.back().first + rods.back().count + 2 * body;
    Couplings all = honest ? Couplings::among({node, place, place + 1}) : Couplings::among({node, place});
    if (!derives) return all;
    return std::move(all).with(
        [this, place](const StateView& s, LoadDerivatives& to) { derive(s, place, to); });
  }
  void derive(const StateView& state, std::size_t place, LoadDerivatives& to) const {
    const Pull f = pull(state);
    const Mat3 one = Mat3::Identity();
    const Mat3 arm = cross(f.arm);
    const Mat3 by_turn = stiffness * arm + damping * cross(state.bodies[body].spin) * arm;
    const auto add = [&](std::size_t j, const Mat3& by_x, const Mat3& by_u) {
      to.add_by_position(node, j, -by_x);
      to.add_by_velocity(node, j, -by_u);
      to.add_by_position(place, j, by_x);
      to.add_by_velocity(place, j, by_u);
      to.add_by_position(place + 1, j, arm * by_x);
      to.add_by_velocity(place + 1, j, arm * by_u);
    };
    add(node, stiffness * one, damping * one);
    add(place, -stiffness * one, -damping * one);
    add(place + 1, by_turn, damping * arm);
    to.add_by_position(place + 1, place + 1, cross(f.force) * arm);
  }
  bool depends_on_time() const override { return false; }
  bool has_energy() const override { return damping == 0.0; }
  double energy(const StateView& state) const override {
    return 0.5 * stiffness * pull(state).stretch.squaredNorm();
  }
};

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

Tie tie_of(double stiffness, double damping) {
  Tie tie;
  tie.node = 2;
  tie.body = 1;
  tie.at = Vec3(0.3, -0.1, 0.2);
  tie.stiffness = stiffness;
  tie.damping = damping;
  return tie;
}

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

/// A free rod that a spring ties to the surface of a spinning body.
Scene tied(bool derives, double stiffness, double damping) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  Body body = test::body_of({0.02, 0.03, 0.04}, 1.0);
  body.position = Vec3(1.0, 0.1, 0.4);
  body.velocity = Vec3(0, 0.3, -0.2);
  body.spin = Vec3(2, -1, 3);
  Body other = body;
  other.position = Vec3(5, 5, 5);
  scene.bodies = {other, body};
  auto tie = std::make_shared<Tie>(tie_of(stiffness, damping));
  tie->node = 6;
  tie->at = Vec3(0.1, 0.0, -0.15);
  tie->derives = derives;
  scene.forces = {tie};
  return scene;
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

INSTANTIATE_TEST_SUITE_P(Methods, Tied, testing::Values(Method::cash_karp, Method::runge_kutta4),
                         [](const auto& method) { return to_string(method.param); });

}  // namespace
}  // namespace tendril
