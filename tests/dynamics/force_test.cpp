#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

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
TEST(Wind, DragsEveryEdgeByTheAirAtItsMiddle) {
  const WindOptions options = gusty(8);
  const Wind wind(options);
  test::Random random(6);
  std::vector<NodeRange> rods;
  std::vector<Vec3> p, v, t;
  for (const std::size_t count : {1, 2, 97, 3, 200, 31}) {
    rods.push_back({p.size(), count});
    for (std::size_t i = 0; i < count; ++i) {
      p.push_back(Vec3(0.1 * static_cast<double>(i), 0, 0) + random.in_cube(0.05));
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
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LT((force[i] - expected[i]).norm(), 1e-14) << i;
}

}  // namespace
}  // namespace tendril
