#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/bindingf.h>
#include <tendril/bind/mesh_follower.h>
#include <tendril/dynamics/rod_curves.h>

#include "support/numbers.h"
#include "support/pairs.h"
#include "support/random.h"

// Twists of more than 60 degrees an edge, which an orientation curve does not show well, or at all.
namespace tendril::bind {
namespace {

using tendril::test::kPi;
using test::Random;

struct Bound {
  CurvePair rest, posed;
  std::vector<Vec3> points;
};

Bound make_bound(int count) {
  Random random(7);
  std::vector<Vec3> p, bent;
  for (int i = 0; i < 8; ++i) {
    p.emplace_back(i, 0, 0);
    bent.emplace_back(i, 0.3 * std::sin(0.8 * i), 0.2 * std::cos(i));
  }
  const Interpolator fit(3, p);
  const auto pair = [&](const std::vector<Vec3>& chain) {
    return CurvePair(fit.knots(), fit.solve(chain),
                     fit.solve(orientation_towards(chain, Vec3::UnitZ(), 0.5)));
  };
  Bound out{pair(p), pair(bent), {}};
  std::vector<double> turn;
  for (int i = 0; i < 8; ++i) turn.push_back(2.0 * i + random.uniform(-1, 1));
  out.posed.set_turn(turn);
  for (int i = 0; i < count; ++i)
    out.points.push_back(Vec3(random.uniform(-0.5, 7.5), 0, 0) + random.in_cube(0.4));
  return out;
}

TEST(Turn, TurnsTheFrameAboutTheTangent) {
  Bound b = make_bound(0);
  CurvePair plain = b.posed;
  plain.set_turn({});
  const double start = b.posed.turn().front();
  const Frame before = plain.frame(0.0).frame, after = b.posed.frame(0.0).frame;
  EXPECT_LT((after.y - rotate_about(before.z, start, before.y)).norm(), 1e-14);
  EXPECT_LT((after.x - after.y.cross(after.z)).norm(), 1e-14);
  EXPECT_EQ(after.z, before.z);
  EXPECT_THROW(plain.set_turn({1.0}), InvalidInput);
  EXPECT_THROW(plain.set_turn(std::vector<double>(8, std::nan(""))), InvalidInput);
}

TEST(Turn, IsFollowedByEveryFormOfAnUpdate) {
  const Bound b = make_bound(3000);
  const Binding binding(b.rest, b.points);
  std::vector<Vec3> rows(b.points.size()), again = rows;
  binding.update(b.posed, rows);
  binding.update(b.posed, again, 3);
  EXPECT_EQ(rows, again);
  std::vector<Eigen::Vector3f> single(rows.size());
  const Bindingf rounded(binding);
  rounded.update({&b.posed, 1}, single);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_LT((rows[i] - from_axial(b.posed, binding.records()[i])).norm(), 1e-13);
    EXPECT_EQ(rows[i], binding.at(b.posed, i));
    EXPECT_LT((single[i].cast<double>() - rows[i]).norm(), 1e-4);
    EXPECT_EQ(single[i], rounded.at({&b.posed, 1}, i));
  }
}

TEST(Turn, IsHeldWhereForcesArePulledBack) {
  const Bound b = make_bound(500);
  const Binding binding(b.rest, b.points);
  Random random(3);
  std::vector<Vec3> f(binding.size()), du(8), dv(8), low(binding.size()), high = low;
  std::vector<std::uint32_t> all(binding.size());
  for (Vec3& x : f) x = random.in_cube();
  for (std::size_t i = 0; i < 8; ++i) du[i] = random.in_cube(), dv[i] = random.in_cube();
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  const auto at = [&](double h, std::vector<Vec3>& out) {
    CurvePair pair = b.posed;
    std::vector<Vec3> u(pair.primary().control_points().begin(), pair.primary().control_points().end());
    std::vector<Vec3> v(pair.orientation().control_points().begin(),
                        pair.orientation().control_points().end());
    for (std::size_t i = 0; i < 8; ++i) u[i] += h * du[i], v[i] += h * dv[i];
    pair.set_control_points(u, v);
    binding.update(pair, out);
  };
  const double h = 1e-5;
  at(-h, low);
  at(h, high);
  double expected = 0.0, size = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    expected += f[i].dot(high[i] - low[i]) / (2 * h);
    size += f[i].norm() * (high[i] - low[i]).norm() / (2 * h);
  }
  const auto whole = binding.pull_back({&b.posed, 1}, f), alone = binding.pull_back({&b.posed, 1}, all, f);
  for (const auto& g : {whole, alone}) {
    double work = 0.0;
    for (std::size_t i = 0; i < 8; ++i) work += g[0].primary[i].dot(du[i]) + g[0].orientation[i].dot(dv[i]);
    EXPECT_NEAR(work, expected, 1e-8 * size);
  }
}

/// A straight rod along x, a torque on which brings in its twist state.
struct Turner : Force {
  void add(const StateView&, const Loads&) const override {}
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::within(1); }
  bool twists() const override { return true; }
};

constexpr int kNodes = 11;

System twistable() {
  std::vector<Vec3> p;
  for (int i = 0; i < kNodes; ++i) p.emplace_back(0.1 * i, 0, 0);
  Scene scene;
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {1e6, 4e5, 1000}, circular_section(0.05)));
  scene.forces.push_back(std::make_shared<Turner>());
  return System(scene);
}

/// Turned by `edge` from node to node, in steps that the twist is unwrapped over.
State twisted(const System& system, double edge, System::Workspace& work) {
  State state = system.rest_state();
  const int steps = 1 + static_cast<int>(edge * kNodes);
  for (int k = 0; k < steps; ++k) {
    for (int i = 0; i < kNodes; ++i) state.y[6 * kNodes + i] += edge * i / steps;
    EXPECT_TRUE(system.rebase(state, work).ok());
  }
  return state;
}

/// A vertex between two nodes is turned by the mean of their unwrapped angles.
TEST(Turn, FollowsAnyTwistOfAnEdge) {
  const System system = twistable();
  const RodCurves curves(system);
  const auto work = system.make_workspace();
  const std::vector<CurvePair> rest = curves.pairs(system, system.rest_state(), *work);
  std::vector<Vec3> points;
  for (int i = 0; i <= 200; ++i) points.emplace_back(i / 200.0, 0.05, 0.0);
  const Binding binding(rest[0], points);
  for (const double degrees : {30.0, 59.0, 90.0, 144.0, 180.0, 270.0, 720.0, 1000.0}) {
    const double edge = degrees * kPi / 180.0;
    const auto pairs = curves.pairs(system, twisted(system, edge, *work), *work);
    EXPECT_EQ(pairs[0].turn().empty(), degrees <= 60.0) << degrees;
    std::vector<Vec3> at(points.size());
    binding.update(pairs[0], at);
    double worst = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double angle = 10.0 * edge * points[i].x();
      const Vec3 expected(points[i].x(), 0.05 * std::cos(angle), 0.05 * std::sin(angle));
      worst = std::max(worst, (at[i] - expected).norm() / 0.05);
    }
    std::printf("%5.0f degrees an edge: vertices within %.4f radii\n", degrees, worst);
    EXPECT_LT(worst, 0.04) << degrees;
  }
}

/// No jump where the turn begins to count.
TEST(Turn, BeginsContinuously) {
  const System system = twistable();
  const RodCurves curves(system);
  const auto work = system.make_workspace();
  const auto at = [&](double edge) { return curves.pairs(system, twisted(system, edge, *work), *work)[0]; };
  const CurvePair before = at(kPi / 3 - 1e-7), after = at(kPi / 3 + 1e-7);
  ASSERT_TRUE(before.turn().empty());
  ASSERT_FALSE(after.turn().empty());
  for (int i = 0; i <= 50; ++i)
    EXPECT_LT((before.frame(i / 50.0).frame.y - after.frame(i / 50.0).frame.y).norm(), 1e-5);
}

}  // namespace
}  // namespace tendril::bind
