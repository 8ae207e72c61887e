#include <gtest/gtest.h>
#include <tendril/bind/bindingf.h>
#include <tendril/bind/mesh_follower.h>

#include "support/pairs.h"
#include "support/random.h"

// Points between two axes, which take part in nodes of both: every form of an update, and what goes with it.
namespace tendril::bind {
namespace {

using Vectors = std::vector<Vec3>;

/// A sheet over a trunk and a branch, at a place.
struct Forked {
  std::vector<CurvePair> rest, posed, rates;
  PolygonMesh mesh;
};

Forked fork(int degree, const Vec3& at, bool turned) {
  test::Random random(static_cast<std::uint64_t>(degree) + 40);
  Forked out;
  Vectors line;
  for (int i = 0; i < 8; ++i) line.emplace_back(0.5 * i, 0, 0);
  const Interpolator fit(degree, line);
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0.6, 0.8, 0)}) {
    Vectors u[3], v[3];
    for (int i = 0; i < 8; ++i) {
      const Vec3 p = at + 0.5 * i * along, q = p + Vec3(0.1, 0, 0.4);
      const Vec3 du = random.in_cube(0.2), dv = random.in_cube(0.1);
      u[0].push_back(p), v[0].push_back(q);
      u[1].push_back(p + du), v[1].push_back(q + du + dv);
      u[2].push_back(random.in_cube()), v[2].push_back(random.in_cube());
    }
    out.rest.emplace_back(fit.knots(), fit.solve(u[0]), fit.solve(v[0]));
    out.posed.emplace_back(fit.knots(), fit.solve(u[1]), fit.solve(v[1]));
    out.rates.emplace_back(fit.knots(), fit.solve(u[2]), fit.solve(v[2]));
    if (!turned) continue;
    std::vector<double> turn;
    for (int i = 0; i < 8; ++i) turn.push_back(1.5 * i + random.uniform(-1, 1));
    out.posed.back().set_turn(turn);
  }
  for (int i = 0; i <= 60; ++i)
    for (int j = 0; j <= 40; ++j) out.mesh.points.push_back(at + Vec3(0.06 * i, 0.06 * j - 0.4, 0.15));
  for (std::uint32_t i = 0; i < 60; ++i)
    for (std::uint32_t j = 0; j < 40; ++j) {
      const std::uint32_t a = 41 * i + j;
      out.mesh.corners.insert(out.mesh.corners.end(), {a, a + 41, a + 42, a + 1});
      out.mesh.face_begin.push_back(static_cast<std::uint32_t>(out.mesh.corners.size()));
    }
  return out;
}

Vectors by_shares(const Binding& binding, std::span<const CurvePair> posed) {
  Vectors out;
  for (std::size_t i = 0; i < binding.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (const Share& share : binding.shares(i)) {
      sum += share.weight * from_axial(posed[share.pair], share.record);
      whole += share.weight;
    }
    EXPECT_NEAR(whole, 1.0, 1e-15);
    out.push_back(sum);
  }
  return out;
}

double farthest(const Vectors& a, const Vectors& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

/// Of a degree; turned or not.
class Shared : public testing::TestWithParam<std::tuple<int, bool>> {};
INSTANTIATE_TEST_SUITE_P(Degrees, Shared,
                         testing::Combine(testing::Range(1, kMaxDegree + 1), testing::Bool()));

TEST_P(Shared, AreTheMeanOfTheirPlacesInEveryForm) {
  const auto [degree, turned] = GetParam();
  const Forked f = fork(degree, Vec3(3, -2, 5), turned);
  const Binding binding(f.rest, f.mesh, {});
  const std::size_t n = binding.size();
  ASSERT_GT(binding.report().ambiguous.size(), n / 4);
  EXPECT_LT(binding.report().rest_error, 2e-14);
  Vectors rows(n), again(n), some(n);
  binding.update(f.posed, rows);
  binding.update(f.posed, again, 3);
  EXPECT_EQ(rows, again);
  EXPECT_LT(farthest(rows, by_shares(binding, f.posed)), 1e-13);
  EXPECT_GT(farthest(rows, f.mesh.points), 0.1);
  std::vector<double> x(n), y(n), z(n);
  binding.update(f.posed, Columns<double>{x, y, z}, 2);
  std::vector<std::uint32_t> backwards;
  for (std::uint32_t i = 0; i < n; ++i) backwards.push_back(static_cast<std::uint32_t>(n) - 1 - i);
  binding.at(f.posed, backwards, some);
  const Bindingf rounded(binding);
  std::vector<Eigen::Vector3f> single(n);
  rounded.update(f.posed, single, 2);
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t i = binding.order()[k];
    EXPECT_EQ(rows[i], Vec3(x[k], y[k], z[k]));
    EXPECT_EQ(rows[i], binding.at(f.posed, i));
    EXPECT_EQ(rows[i], some[n - 1 - i]);
    EXPECT_EQ(single[i], rounded.at(f.posed, i));
    EXPECT_LT((single[i].cast<double>() - rows[i]).norm(), 3e-5);
  }
}

TEST_P(Shared, MoveAsTheirDifferencesAndForcesDoTheWork) {
  const auto [degree, turned] = GetParam();
  const Forked f = fork(degree, Vec3(3, -2, 5), turned);
  const Binding binding(f.rest, f.mesh, {});
  const std::size_t n = binding.size();
  const auto moved = [&](double by) {
    std::vector<CurvePair> out = f.posed;
    for (std::size_t k = 0; k < out.size(); ++k) {
      const auto sum = [&](Points a, Points b) {
        Vectors p(a.begin(), a.end());
        for (std::size_t i = 0; i < p.size(); ++i) p[i] += by * b[i];
        return p;
      };
      out[k].set_control_points(
          sum(f.posed[k].primary().control_points(), f.rates[k].primary().control_points()),
          sum(f.posed[k].orientation().control_points(), f.rates[k].orientation().control_points()));
    }
    Vectors points(n);
    binding.update(out, points);
    return points;
  };
  const double h = 1e-6;
  const Vectors low = moved(-h), high = moved(h);
  std::vector<std::uint32_t> all(n);
  for (std::uint32_t i = 0; i < n; ++i) all[i] = i;
  Vectors velocity(n), force(n);
  binding.velocities(f.posed, f.rates, all, velocity);
  test::Random random(9);
  double work = 0.0, size = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_LT(((high[i] - low[i]) / (2 * h) - velocity[i]).norm(), 1e-7);
    force[i] = random.in_cube();
    work += force[i].dot(velocity[i]);
    size += force[i].norm() * velocity[i].norm();
  }
  const auto one = binding.pull_back(f.posed, force, 1), three = binding.pull_back(f.posed, force, 3);
  const auto alone = binding.pull_back(f.posed, all, force);
  double whole = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < f.posed.size(); ++k) {
    EXPECT_EQ(one[k].primary, three[k].primary);
    EXPECT_EQ(one[k].orientation, three[k].orientation);
    for (std::size_t i = 0; i < one[k].primary.size(); ++i) {
      const Vec3 &du = f.rates[k].primary().control_points()[i],
                 &dv = f.rates[k].orientation().control_points()[i];
      whole += one[k].primary[i].dot(du) + one[k].orientation[i].dot(dv);
      sum += alone[k].primary[i].dot(du) + alone[k].orientation[i].dot(dv);
    }
  }
  EXPECT_NEAR(whole, work, 1e-14 * size);
  EXPECT_NEAR(sum, work, 1e-14 * size);
}

/// A million sizes from the origin the numbers' own spacing is all that is lost.
TEST(SharedPoints, KeepAnyPlace) {
  const Vec3 far(3e6, -2e6, 1e6);
  const Forked here = fork(3, Vec3::Zero(), false), there = fork(3, far, false);
  const Binding near(here.rest, here.mesh, {}), away(there.rest, there.mesh, {});
  EXPECT_LT(away.report().rest_error, 4e-9);
  Vectors a(near.size()), b(near.size());
  near.update(here.posed, a);
  away.update(there.posed, b);
  EXPECT_LT(farthest(b, by_shares(away, there.posed)), 4e-9);
}

/// Where a posed orientation curve is on its axis, frames are by the rule of the curve-pair.
TEST(SharedPoints, AreLeftToTheRulesOfTheCurvePairWithoutAFrame) {
  Forked f = fork(3, Vec3::Zero(), false);
  const Points u = f.posed[1].primary().control_points();
  f.posed[1] = CurvePair(f.posed[1].knots(), Vectors(u.begin(), u.end()), Vectors(u.begin(), u.end()));
  const Binding binding(f.rest, f.mesh, {});
  Vectors rows(binding.size());
  binding.update(f.posed, rows, 2);
  EXPECT_LT(farthest(rows, by_shares(binding, f.posed)), 1e-13);
  for (std::size_t i = 0; i < rows.size(); i += 7) EXPECT_EQ(rows[i], binding.at(f.posed, i));
}

}  // namespace
}  // namespace tendril::bind
