#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <limits>
#include <numbers>

#include "support/random.h"
#include "support/rods.h"

namespace tendril {
namespace {

/// Gravity by another name; its loads are never asked for.
struct Falling : Force {
  explicit Falling(const Vec3& a) : acceleration(a) {}
  void add(const StateView&, const Loads&) const override { throw std::logic_error("add() was called"); }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  std::optional<Vec3> uniform_acceleration() const override { return acceleration; }
  Vec3 acceleration;
};

State fallen(std::vector<std::shared_ptr<const Force>> forces, Energies* last = nullptr) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = std::move(forces);
  const System system(scene);
  Simulation simulation(system, system.rest_state());
  const Report report = simulation.run(0.1);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  if (last) *last = report.last;
  return simulation.state();
}

TEST(UniformAcceleration, IsGravityWhoeverSaysIt) {
  const Vec3 a(0.25, 0, -8), b(0.5, 1, -2);
  Energies own, gravity;
  const State state = fallen({std::make_shared<Falling>(a), std::make_shared<Falling>(b)}, &own);
  EXPECT_EQ(state.y, fallen({std::make_shared<Gravity>(a + b)}, &gravity).y);
  EXPECT_NE(state.y, fallen({std::make_shared<Gravity>(a)}).y);
  EXPECT_EQ(own.potential, gravity.potential);
  EXPECT_LT(own.potential, 0.0);
}

WindOptions gusty(int waves) {
  WindOptions wind;
  wind.mean = Vec3(3, -1, 0.5);
  wind.gust = 0.6;
  wind.gust_frequency = 2.0;
  wind.waves = waves;
  wind.seed = 7;
  return wind;
}

/// u(x, t) = mean (1 + gust / sqrt(waves) sum_k sin(2 pi f_k (t - x.d / |mean|) + phi_k)), the phases as the
/// air at the origin shows them.
TEST(Wind, CarriesItsWavesAlong) {
  constexpr Eigen::Index kWaves = 5;
  const WindOptions options = gusty(kWaves);
  const Wind wind(options);
  const double square = options.mean.squaredNorm();
  std::array<double, kWaves> omega;
  for (std::size_t k = 0; k < kWaves; ++k)
    omega[k] = 2 * std::numbers::pi * 2.0 * std::pow(10.0, static_cast<double>(k) / (kWaves - 1) - 0.5);
  const auto gust = [&](const Vec3& x, double t) {
    return (wind.velocity(x, t).dot(options.mean) / square - 1.0) / options.gust * std::sqrt(kWaves);
  };
  Eigen::MatrixXd terms(4 * kWaves, 2 * kWaves);
  Eigen::VectorXd seen(4 * kWaves);
  for (Eigen::Index j = 0; j < 4 * kWaves; ++j) {
    const double t = 0.07 * static_cast<double>(j);
    for (Eigen::Index k = 0; k < kWaves; ++k) {
      terms(j, 2 * k) = std::cos(omega[static_cast<std::size_t>(k)] * t);
      terms(j, 2 * k + 1) = std::sin(omega[static_cast<std::size_t>(k)] * t);
    }
    seen[j] = gust(Vec3::Zero(), t);
  }
  const Eigen::VectorXd part = terms.colPivHouseholderQr().solve(seen);
  EXPECT_LT((terms * part - seen).cwiseAbs().maxCoeff(), 1e-13);
  for (Eigen::Index k = 0; k < kWaves; ++k) EXPECT_NEAR(part.segment<2>(2 * k).norm(), 1.0, 1e-11);
  test::Random random(5);
  // The last is farther than sines of many at once are taken.
  for (const double size : {0.1, 30.0, 1e4, 1e7})
    for (int round = 0; round < 200; ++round) {
      const Vec3 x = random.in_cube(size);
      const double t = random.uniform(0.0, 50.0), passed = t - x.dot(options.mean) / square;
      double expected = 0.0;
      for (std::size_t k = 0; k < kWaves; ++k) {
        const auto i = static_cast<Eigen::Index>(2 * k);
        expected += part[i] * std::cos(omega[k] * passed) + part[i + 1] * std::sin(omega[k] * passed);
      }
      EXPECT_NEAR(gust(x, t), expected, 1e-11 + 1e-14 * size) << size;
    }
  // Where a phase has no digits left it is still one.
  for (int round = 0; round < 20; ++round)
    EXPECT_LE(std::abs(gust(random.in_cube(1e19), 0.0)), kWaves + 1e-9);
}

/// Edges more than a block has, in rods of any length, by the air at their middles.
/// \param size  of all
void drags_every_edge(double size, int waves) {
  const WindOptions options = gusty(waves);
  const Wind wind(options);
  test::Random random(6);
  std::vector<NodeRange> rods;
  std::vector<Vec3> p, v, t;
  for (const std::size_t count : {1, 2, 97, 3, 200, 31}) {
    rods.push_back({p.size(), count});
    for (std::size_t i = 0; i < count; ++i) {
      p.push_back(size * (Vec3(0.1 * static_cast<double>(i), 0, 0) + random.in_cube(0.05)));
      v.push_back(random.in_cube(2.0));
      t.push_back(Vec3::UnitX());
    }
  }
  p[150] = p[149];  // an edge without length is in no air
  std::vector<double> spin(p.size(), 0.0), mass(p.size(), 1.0), width;
  for (std::size_t i = 0; i < p.size(); ++i) width.push_back(random.uniform(0.01, 0.05));
  std::vector<Vec3> force(p.size(), Vec3::Zero()), torque = force, expected = force;
  wind.add({1.3, p, v, t, spin, mass, width, rods}, {force, torque});
  for (const NodeRange& rod : rods)
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      const Vec3 edge = p[i + 1] - p[i];
      if (edge.isZero(0.0)) continue;
      const Vec3 flow = 0.5 * (v[i] + v[i + 1]) - wind.velocity(0.5 * (p[i] + p[i + 1]), 1.3);
      const Vec3 e = edge.normalized(), along = flow.dot(e) * e, across = flow - along;
      const Vec3 drag =
          -0.5 * options.air_density * width[i] * edge.norm() *
          (options.normal_drag * across.norm() * across + options.tangential_drag * along.norm() * along);
      expected[i] += 0.5 * drag;
      expected[i + 1] += 0.5 * drag;
    }
  for (std::size_t i = 0; i < p.size(); ++i)
    EXPECT_LT((force[i] - expected[i]).norm(), 1e-14 * std::max(size, 1.0) * (1.0 + size))
        << i << " " << size << " " << waves;
}

/// Small, the air at all of a block is one series; large, a wave turns many times.
TEST(Wind, DragsEveryEdgeByTheAirAtItsMiddle) {
  for (const double size : {1e-3, 0.03, 0.2, 0.5, 1.0, 30.0, 1e7})
    for (const int waves : {0, 1, 8, 19}) drags_every_edge(size, waves);
}

/// Adds nothing, and notes what it is shown.
struct Onlooker : Force {
  explicit Onlooker(bool frames) : looks_at_frames(frames) {}
  void add(const StateView& state, const Loads& loads) const override {
    shown = {state.p.size(),    state.t.size(),    state.m.size(),
             state.spin.size(), state.turn.size(), loads.torque.size()};
  }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  bool acts_on_frames() const override { return looks_at_frames; }
  bool looks_at_frames;
  mutable std::array<std::size_t, 6> shown{};
};

/// A tree of viscous rods that are bent and curved, with a hinge, a swivel and a rod without twist beside it.
Scene windy_tree(std::shared_ptr<const Force> also) {
  test::Random random(8);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 12));
  scene.rods[0].viscosity = 1e-3;
  for (const std::size_t node : {4u, 4u, 11u}) {
    Rod child = test::uneven_rod(random, 7);
    const Vec3 by = scene.rods[0].p[node] - child.p[0];
    for (auto* points : {&child.p, &child.q})
      for (Vec3& point : *points) point += by;
    scene.rods.push_back(std::move(child));
    scene.joints.push_back({.parent = 0, .node = node, .child = scene.rods.size() - 1});
  }
  scene.rods.push_back(test::straight_rod(9, 1e5, 0.02));
  scene.rods.push_back(test::straight_rod(9, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0, .swivels = true});
  scene.anchors.push_back({.rod = 4, .node = 0});
  scene.anchors.push_back({.rod = 5, .node = 3, .holds_frame = false});
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -9.81)), std::make_shared<Wind>(gusty(8)),
                  std::make_shared<PullTowards>(0, 5, Vec3(1, 1, 1), 3.0), std::move(also)};
  return scene;
}

TEST(Frames, AreLeftOutWhereNoForceActsOnThem) {
  const auto aside = std::make_shared<Onlooker>(false), close = std::make_shared<Onlooker>(true);
  const System without(windy_tree(aside)), with(windy_tree(close));
  const auto work = without.make_workspace(), work_with = with.make_workspace();
  State state = without.rest_state();
  test::Random random(9);
  for (Eigen::Index i = 0; i < state.y.size(); ++i) state.y[i] += 0.02 * random.uniform(-1.0, 1.0);
  Eigen::VectorXd rates, rates_with;
  ASSERT_TRUE(without.derivative(state, 0.7, state.y, rates, *work).ok());
  ASSERT_TRUE(with.derivative(state, 0.7, state.y, rates_with, *work_with).ok());
  EXPECT_LE((rates - rates_with).cwiseAbs().maxCoeff(), 1e-14 * rates_with.cwiseAbs().maxCoeff());
  const std::size_t n = without.node_count();
  EXPECT_EQ(aside->shown, (std::array<std::size_t, 6>{n, 0, 0, 0, 0, 0}));
  EXPECT_EQ(close->shown, (std::array<std::size_t, 6>{n, n, n, n, n, n}));
  const Energies a = without.energies(state, *work), b = with.energies(state, *work_with);
  EXPECT_EQ(a.potential, b.potential);
  EXPECT_NEAR(a.elastic, b.elastic, 1e-14 * b.elastic);
  EXPECT_NEAR(a.kinetic, b.kinetic, 1e-14 * b.kinetic);
  state.y[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(without.derivative(state, 0.7, state.y, rates, *work).outcome, Evaluation::Outcome::not_finite);
}

/// Implicit steps ask forces in other ways.
TEST(Frames, AreMissedByNoImplicitStep) {
  const System without(windy_tree(std::make_shared<Onlooker>(false)));
  const System with(windy_tree(std::make_shared<Onlooker>(true)));
  const auto end = [](const System& system) {
    Simulation simulation(system, system.rest_state(), {.method = Method::rodas, .tolerance = 1e-4});
    const Report report = simulation.run(0.2);
    EXPECT_EQ(report.stop, Stop::finished) << report.reason;
    return simulation.state().y;
  };
  const Eigen::VectorXd a = end(without), b = end(with);
  EXPECT_LE((a - b).head(3 * static_cast<Eigen::Index>(without.node_count())).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Frames, AreLeftAloneByWhoSaysSo) {
  const System system(windy_tree(std::make_shared<Onlooker>(true)));
  struct Turner : Onlooker {
    Turner() : Onlooker(false) {}
    void add(const StateView&, const Loads& loads) const override { loads.torque[3] += Vec3::UnitX(); }
  };
  struct Peeper : Onlooker {
    Peeper() : Onlooker(false) {}
    void add(const StateView& state, const Loads& loads) const override { loads.force[3] += state.t[3]; }
  };
  std::vector<Vec3> p = test::straight(5, 1.0), v(6, Vec3::UnitZ()), t(6, Vec3::UnitX());
  const std::vector<double> ones(6, 1.0);
  const std::vector<NodeRange> rods{{0, 6}};
  const StateView view{0.0, p, v, t, ones, ones, ones, rods};
  EXPECT_FALSE(check_force(Turner(), view).frames);
  EXPECT_FALSE(check_force(Peeper(), view).frames);
  for (const auto& force : system.scene().forces) EXPECT_TRUE(check_force(*force, view).frames);
  EXPECT_TRUE(
      check_force(PointLoad(PointLoad::Kind::torque, 0, 2, Vec3::UnitX(), Signal::constant(1.0)), view)
          .frames);
}

}  // namespace
}  // namespace tendril
