#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/mesh_follower.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/closest_point.h>

#include "support/pairs.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

std::vector<Vec3> cloud(std::uint64_t seed, int count) {
  test::Random random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const Vec3 around = random.in_cube(2);
    points.push_back(Vec3(random.uniform(-6, 6), 0, 0) + around);
  }
  return points;
}

CurvePair posed(const CurvePair& rest) {
  std::vector<Vec3> u(rest.primary().control_points().begin(), rest.primary().control_points().end());
  std::vector<Vec3> v(rest.orientation().control_points().begin(), rest.orientation().control_points().end());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto bend = [](const Vec3& p) {
      return Vec3(3 * std::sin(p.x() / 4), p.y() + 0.2 * p.x() * p.x(), p.z() - p.x());
    };
    u[i] = bend(u[i]);
    v[i] = bend(v[i]);
  }
  return CurvePair(rest.knots(), u, v);
}

TEST(Binding, IsTheAxialMapOfTheNearestPoint) {
  const std::vector<Vec3> points = cloud(1, 3000);
  const std::vector<Vec3> axis = test::axis_through(points, 0.1);
  const CurvePair rest = test::pair_through(axis, test::side_of(axis), 1.0);
  const CurvePair pose = posed(rest);
  const Binding binding(rest, points);
  const CurveProjector projector(rest.primary());
  std::vector<Vec3> out(points.size());
  binding.update(pose, out);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(binding.records()[i].t, projector.nearest(points[i]).t);
    EXPECT_LT((out[i] - from_axial(pose, to_axial(rest, binding.records()[i].t, points[i]))).norm(), 1e-13);
  }
  EXPECT_LT(binding.report().rest_error, 1e-13 * bounding_diagonal(points));
  EXPECT_GT(binding.report().beyond_ends, 0u);
  EXPECT_TRUE(binding.report().degenerate.empty());
}

TEST(Binding, GivesTheSameBitsForAnyThreadsAndForOnePoint) {
  const std::vector<Vec3> points = cloud(2, 80000);  // enough for an update to take three threads
  const std::vector<Vec3> axis = test::axis_through(points, 0.2);
  const CurvePair rest = test::pair_through(axis, test::side_of(axis), 1.0);
  const CurvePair pose = posed(rest);
  const Binding one(rest, points, 1);
  std::vector<Vec3> expected(points.size());
  one.update(pose, expected);
  for (const int threads : {2, 3, 7}) {
    std::vector<Vec3> out(points.size());
    Binding(rest, points, threads).update(pose, out, threads);
    EXPECT_EQ(out, expected) << threads;
  }
  for (std::size_t i = 0; i < points.size(); i += 97) EXPECT_EQ(one.at(pose, i), expected[i]);
}

TEST(Binding, SurvivesAPoseWithoutSpeedOrOffset) {
  const std::vector<Vec3> points = cloud(3, 500);
  const std::vector<Vec3> axis = test::axis_through(points, 0.0);
  const CurvePair rest = test::pair_through(axis, test::side_of(axis), 1.0);
  const Binding binding(rest, points);
  std::vector<Vec3> out(points.size());
  const std::vector<Vec3> collapsed(12, Vec3(1, 2, 3));
  binding.update(CurvePair(rest.knots(), collapsed, collapsed), out);
  EXPECT_TRUE(all_finite(out));
  const std::vector<Vec3> u(rest.primary().control_points().begin(), rest.primary().control_points().end());
  binding.update(CurvePair(rest.knots(), u, u), out);
  EXPECT_TRUE(all_finite(out));
}

TEST(Binding, ReportsPointsTheAxisBendsRound) {
  std::vector<Vec3> axis;
  for (int i = 0; i < 13; ++i) axis.emplace_back(std::cos(0.5 * i), std::sin(0.5 * i), 0);
  const CurvePair ring = test::pair_through(axis, Vec3::UnitZ(), 0.5);
  // Past the centre of curvature the nearest point is on the other side of the ring, so lambda stays
  // positive; a little above the centre it is small, and outside the ring it is more than 1.
  const std::vector<Vec3> points{{0.9, 0.1, 0}, {1.5, 0.1, 0}};
  const Binding binding(ring, points);
  EXPECT_TRUE(binding.report().past_focus.empty());
  EXPECT_LT(binding.report().rest_error, 1e-14);
}

TEST(Binding, RefusesBadInput) {
  const std::vector<Vec3> points = cloud(4, 10);
  const std::vector<Vec3> axis = test::axis_through(points, 0.0);
  const CurvePair rest = test::pair_through(axis, test::side_of(axis), 1.0);
  std::vector<Vec3> bad = points;
  bad[7].z() = std::nan("");
  try {
    const Binding binding(rest, bad);
    FAIL() << "accepted NaN";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.place(), "points[7]");
  }
  EXPECT_THROW(Binding(rest, points, 0), InvalidInput);
  const Binding binding(rest, points);
  std::vector<Vec3> out(9);
  EXPECT_THROW(binding.update(rest, out), InvalidInput);
  out.resize(10);
  const KnotVector other = KnotVector::uniform(3, 12);
  const std::vector<Vec3> u(rest.primary().control_points().begin(), rest.primary().control_points().end());
  EXPECT_THROW(binding.update(CurvePair(other, u, u), out), InvalidInput);
  EXPECT_THROW(binding.at(rest, 10), InvalidInput);
}

TEST(MeshFollower, UpdatesItsPointsAtEveryCall) {
  const std::vector<Vec3> points = cloud(5, 400);
  const std::vector<Vec3> axis = test::axis_through(points, 0.1);
  const CurvePair rest = test::pair_through(axis, test::side_of(axis), 1.0);
  const Binding binding(rest, points);
  std::vector<Vec3> out(points.size());
  MeshFollower follower(binding, 1, out);
  const std::vector<CurvePair> pairs{rest, posed(rest)};
  follower.follow(0.5, pairs);
  std::vector<Vec3> expected(points.size());
  binding.update(pairs[1], expected);
  EXPECT_EQ(out, expected);
  EXPECT_EQ(follower.time(), 0.5);
  EXPECT_EQ(follower.updates(), 1);
  EXPECT_THROW(follower.follow(0.6, std::span(pairs).first(1)), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
