#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/judge.h>

#include "bind/unit_missing.h"
#include "differential/moments.h"
#include "support/pairs.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

using Vectors = std::vector<Vec3>;

Vectors random_vectors(std::size_t count, double half, test::Random& random) {
  Vectors v;
  for (std::size_t i = 0; i < count; ++i) v.push_back(random.in_cube(half));
  return v;
}

CurvePair moved(const CurvePair& pair, const Vectors& du, const Vectors& dv, double step) {
  Vectors u(pair.primary().control_points().begin(), pair.primary().control_points().end());
  Vectors v(pair.orientation().control_points().begin(), pair.orientation().control_points().end());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] += step * du[i];
    v[i] += step * dv[i];
  }
  return {pair.knots(), u, v};
}

CurvePair bent(const CurvePair& rest, double by) {
  test::Random random(11);
  const std::size_t n = rest.primary().control_points().size();
  const Vectors du = random_vectors(n, by, random);
  return moved(rest, du, random_vectors(n, by, random), 1.0);
}

double dot(Points a, Points b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Derivative of the bound points by the step along (du, dv): differences of step h and 2 h, extrapolated,
/// then once more; their error is below 1e-12 at the h taken.
Vectors tangent(const Binding& binding, const CurvePair& posed, const Vectors& du, const Vectors& dv) {
  const auto difference = [&](double h) {
    Vectors plus(binding.size()), minus(binding.size());
    binding.update(moved(posed, du, dv, h), plus);
    binding.update(moved(posed, du, dv, -h), minus);
    for (std::size_t i = 0; i < plus.size(); ++i) plus[i] = (plus[i] - minus[i]) / (2 * h);
    return plus;
  };
  const double h = 1.0 / 256;
  std::array<Vectors, 4> level{difference(h), difference(h / 2), difference(h / 4), difference(h / 8)};
  for (std::size_t round = 1; round < level.size(); ++round)
    for (std::size_t k = level.size() - 1; k >= round; --k)
      for (std::size_t i = 0; i < level[k].size(); ++i)
        level[k][i] += (level[k][i] - level[k - 1][i]) / (std::pow(4.0, round) - 1);
  return level.back();
}

struct Bound {
  CurvePair rest, posed;
  Vectors points;
};

Bound make_bound(int degree, int count) {
  test::Random random(static_cast<std::uint64_t>(degree) + 5);
  Vectors axis;
  for (int i = 0; i < 9; ++i) axis.emplace_back(i, 0.3 * std::sin(0.8 * i), 0.2 * std::cos(i));
  const Interpolator fit(degree, axis);
  const CurvePair rest(fit.knots(), fit.solve(axis),
                       fit.solve(orientation_towards(axis, Vec3(0, 0.3, 1).normalized(), 0.7)));
  Vectors points;
  for (int i = 0; i < count; ++i)
    points.push_back(Vec3(random.uniform(-0.5, 8.5), 0, 0) + random.in_cube(0.8));
  return {rest, bent(rest, 0.3), points};
}

class EveryDegree : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, EveryDegree, testing::Range(1, kMaxDegree + 1));

TEST_P(EveryDegree, DoesTheWorkOfTheForcesOnThePoints) {
  const Bound b = make_bound(GetParam(), 3000);
  const Binding binding(b.rest, b.points);
  test::Random random(3);
  const std::size_t n = b.rest.primary().control_points().size();
  for (int trial = 0; trial < 5; ++trial) {
    const Vectors du = random_vectors(n, 1, random), dv = random_vectors(n, 1, random);
    const Vectors f = random_vectors(binding.size(), 1, random);
    const std::vector<ControlForces> g = binding.pull_back({&b.posed, 1}, f);
    const Vectors ds = tangent(binding, b.posed, du, dv);
    const double scale = std::sqrt(dot(f, f) * dot(ds, ds));
    EXPECT_NEAR(dot(g[0].primary, du) + dot(g[0].orientation, dv), dot(f, ds), 1e-12 * scale);
  }
}

/// 10^4 forces, each alone: resultant force and torque about the origin.
TEST(PullBack, KeepsForceAndTorqueOfEveryForce) {
  const Bound b = make_bound(3, 10000);
  const Binding binding(b.rest, b.points);
  Vectors at(binding.size());
  binding.update(b.posed, at);
  test::Random random(4);
  const Points u = b.posed.primary().control_points(), v = b.posed.orientation().control_points();
  double worst_force = 0.0, worst_torque = 0.0;
  for (std::uint32_t i = 0; i < binding.size(); ++i) {
    const Vectors f{random.in_cube(1)};
    const std::vector<std::uint32_t> where{i};
    const ControlForces g = binding.pull_back({&b.posed, 1}, where, f).front();
    Vec3 force = -f[0], torque = -at[i].cross(f[0]);
    for (std::size_t k = 0; k < u.size(); ++k) {
      force += g.primary[k] + g.orientation[k];
      torque += u[k].cross(g.primary[k]) + v[k].cross(g.orientation[k]);
    }
    worst_force = std::max(worst_force, force.norm() / f[0].norm());
    worst_torque = std::max(worst_torque, torque.norm() / (f[0].norm() * at[i].norm()));
  }
  std::printf("force kept to %.1e, torque to %.1e\n", worst_force, worst_torque);
  EXPECT_LT(worst_force, 1e-12);
  EXPECT_LT(worst_torque, 1e-12);
}

TEST(PullBack, SumsWhatItGivesForPointsAlone) {
  const Bound b = make_bound(3, 600);
  const Binding binding(b.rest, b.points);
  test::Random random(5);
  const Vectors f = random_vectors(600, 1, random);
  std::vector<std::uint32_t> all(600);
  for (std::uint32_t i = 0; i < 600; ++i) all[i] = i;
  const auto whole = binding.pull_back({&b.posed, 1}, f);
  const auto single = binding.pull_back({&b.posed, 1}, all, f);
  for (std::size_t i = 0; i < whole[0].primary.size(); ++i) {
    EXPECT_LT((whole[0].primary[i] - single[0].primary[i]).norm(), 1e-11);
    EXPECT_LT((whole[0].orientation[i] - single[0].orientation[i]).norm(), 1e-11);
  }
}

TEST(PullBack, GivesTheSameBitsForAnyThreads) {
  const Bound b = make_bound(3, 60000);
  const Binding binding(b.rest, b.points);
  test::Random random(6);
  const Vectors f = random_vectors(binding.size(), 1, random);
  const auto one = binding.pull_back({&b.posed, 1}, f, 1);
  for (const int threads : {2, 3, 5}) {
    const auto many = binding.pull_back({&b.posed, 1}, f, threads);
    EXPECT_EQ(many[0].primary, one[0].primary);
    EXPECT_EQ(many[0].orientation, one[0].orientation);
  }
}

class EveryVectorUnit : public testing::TestWithParam<VectorUnit> {};
INSTANTIATE_TEST_SUITE_P(PullBack, EveryVectorUnit,
                         testing::Values(VectorUnit::bits_256, VectorUnit::bits_512));

TEST_P(EveryVectorUnit, GivesTheBitsOfThePlainLoop) {
  if (GetParam() > widest_unit()) GTEST_SKIP() << unit_missing(GetParam());
  const Bound b = make_bound(3, 10);
  test::Random random(6);
  const Piece<double> piece = pose<double>(make_span(0, b.rest.knots(), b.rest.knots().span(0.5)), b.posed);
  Records<double> records(203);
  std::vector<double> x(203), y(203), z(203);
  for (auto* column : {&records.s, &records.u, &records.v, &records.w, &x, &y, &z})
    for (double& value : *column) value = random.uniform(-0.5, 0.5);
  Moments plain;
  add_moments_on(VectorUnit::plain, piece, records.from(0), {x.data(), y.data(), z.data()}, 203, plain);
  Moments wide;
  add_moments_on(GetParam(), piece, records.from(0), {x.data(), y.data(), z.data()}, 203, wide);
  EXPECT_EQ(plain.c, wide.c);
  EXPECT_EQ(plain.d, wide.d);
}

/// A hairpin, whose inside is bound to both of its legs.
TEST(PullBack, HoldsForPointsWithSeveralPlaces) {
  Vectors axis;
  for (int i = 0; i <= 20; ++i) {
    const double s = i - 10.0;
    axis.emplace_back(0.5 * s * s / 10, std::atan(s) * 0.7, 0);
  }
  const CurvePair rest = test::pair_through(axis, Vec3::UnitZ(), 0.5);
  PolygonMesh mesh;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j) mesh.points.emplace_back(0.1 * i, 0.05 * j - 1, 0.2);
  for (std::uint32_t i = 0; i < 40; ++i)
    for (std::uint32_t j = 0; j < 40; ++j) {
      const std::uint32_t a = 41 * i + j;
      mesh.corners.insert(mesh.corners.end(), {a, a + 41, a + 42, a + 1});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  BindOptions options;
  options.mode = BindMode::continuous;
  const Binding binding({&rest, 1}, mesh, options);
  ASSERT_GT(binding.report().ambiguous.size(), 20u);
  const CurvePair posed = bent(rest, 0.02);
  test::Random random(8);
  const std::size_t n = axis.size();
  const Vectors du = random_vectors(n, 0.05, random), dv = random_vectors(n, 0.05, random);
  Vectors f(binding.size(), Vec3::Zero());
  Vectors sparse;
  for (const std::uint32_t i : binding.report().ambiguous) sparse.push_back(f[i] = random.in_cube(1));
  const auto g = binding.pull_back({&posed, 1}, f);
  const auto few = binding.pull_back({&posed, 1}, binding.report().ambiguous, sparse);
  const Vectors ds = tangent(binding, posed, du, dv);
  const double scale = std::sqrt(dot(f, f) * dot(ds, ds));
  EXPECT_NEAR(dot(g[0].primary, du) + dot(g[0].orientation, dv), dot(f, ds), 1e-12 * scale);
  EXPECT_NEAR(dot(few[0].primary, du) + dot(few[0].orientation, dv), dot(f, ds), 1e-12 * scale);
}

TEST(PullBack, FollowsTheCurveAloneWithoutAFrame) {
  const Bound b = make_bound(3, 100);
  const Binding binding(b.rest, b.points);
  const Vectors u(b.posed.primary().control_points().begin(), b.posed.primary().control_points().end());
  const CurvePair flat(b.rest.knots(), u, u);
  test::Random random(9);
  const Vectors f = random_vectors(100, 1, random);
  const auto g = binding.pull_back({&flat, 1}, f);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& force : f) sum -= force;
  for (const Vec3& force : g[0].primary) sum += force;
  EXPECT_LT(sum.norm(), 1e-13 * 100);
  for (const Vec3& force : g[0].orientation) EXPECT_EQ(force, Vec3(Vec3::Zero()));
}

TEST(PullBack, RefusesBadInput) {
  const Bound b = make_bound(3, 10);
  const Binding binding(b.rest, b.points);
  Vectors f(9, Vec3::Zero());
  EXPECT_THROW(binding.pull_back({&b.posed, 1}, f), InvalidInput);
  f.push_back(Vec3(0, std::nan(""), 0));
  try {
    binding.pull_back({&b.posed, 1}, f);
    FAIL() << "accepted NaN";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.place(), "forces[9]");
  }
}

}  // namespace
}  // namespace tendril::bind
