#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/judge.h>
#include <tendril/bind/mesh_follower.h>

#include <cmath>

#include "bind/tear_cases.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

/// A tube round a line, wide enough to lie across all that an axis through its box does.
PolygonMesh tube(int along, int round, double height = 1.0, double depth = 0.6) {
  PolygonMesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k < round; ++k) {
      const double a = 2 * std::numbers::pi * k / round;
      mesh.points.emplace_back(4.0 * i / along, height * std::cos(a), depth * std::sin(a));
    }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * round + k % round); };
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < round; ++k) {
      mesh.corners.insert(mesh.corners.end(), {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  return mesh;
}

BindOptions continuous(int threads = 1) {
  return {.mode = BindMode::continuous, .threads = threads};
}

/// A row of triangles along a polyline of points.
PolygonMesh strip(const std::vector<Vec3>& line) {
  PolygonMesh mesh;
  mesh.points = line;
  for (std::uint32_t i = 2; i < line.size(); ++i) {
    mesh.corners.insert(mesh.corners.end(), {i - 2, i - 1, i});
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
  return mesh;
}

std::vector<Vec3> line(const Vec3& from, const Vec3& to, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(from + i / (count - 1.0) * (to - from));
  return points;
}

double longest_step(Points points) {
  double longest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    longest = std::max(longest, (points[i] - points[i - 1]).norm());
  return longest;
}

TEST(ContinuousBinding, GivesTheRestShapeBack) {
  const PolygonMesh mesh = tube(60, 40);
  for (const test::AxisCase& axis : test::tear_axes(mesh.points)) {
    const CurvePair rest = test::tear_pose(axis.rest, 0).rest;
    const Binding binding({&rest, 1}, mesh, continuous());
    EXPECT_LT(binding.report().rest_error, 1e-13 * bounding_diagonal(mesh.points)) << axis.name;
    EXPECT_EQ(binding.report().ambiguous.empty(), axis.name == "straight") << axis.name;
    for (const std::uint32_t i : binding.report().ambiguous) {
      double sum = 0.0;
      for (const Share& share : binding.shares(i)) sum += share.weight;
      EXPECT_NEAR(sum, 1.0, 1e-14);
    }
  }
}

TEST(ContinuousBinding, IsNearestToTheLastBitWhereThatIsUnambiguous) {
  const PolygonMesh mesh = tube(60, 40);
  const test::RestAndPose pair = test::tear_pose(test::tear_axes(mesh.points)[3].rest, 0);
  const Binding nearest(pair.rest, mesh.points), both({&pair.rest, 1}, mesh, continuous());
  std::vector<Vec3> a(mesh.points.size()), b(mesh.points.size());
  nearest.update(pair.posed, a);
  both.update(pair.posed, b);
  std::vector<bool> ambiguous(mesh.points.size(), false);
  for (const std::uint32_t i : both.report().ambiguous) ambiguous[i] = true;
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!ambiguous[i]) EXPECT_EQ(a[i], b[i]);
    same += a[i] == b[i];
  }
  EXPECT_GT(same, a.size() / 2);
  EXPECT_LT(same, a.size());
}

/// A point on the axis has its nearest point where it is: differences of rounding are no other branch.
TEST(ContinuousBinding, IsNearestForPointsOnTheAxisItself) {
  std::vector<Vec3> axis, side, line;
  for (int i = 0; i <= 4; ++i) {
    axis.emplace_back(i, 0, 0);
    side.emplace_back(i, 1, 0);
  }
  const Interpolator fit(3, axis);
  for (int i = 0; i <= 288; ++i) line.emplace_back(i / 72.0, i % 2 == 0 ? 0.0 : 0.1, 0.0);
  const Binding binding(std::vector{CurvePair(fit.knots(), fit.solve(axis), fit.solve(side))}, strip(line),
                        continuous());
  EXPECT_TRUE(binding.report().ambiguous.empty()) << binding.report().ambiguous.size();
}

TEST(ContinuousBinding, GivesTheSameBitsForAnyThreadsAndForOnePoint) {
  const PolygonMesh mesh = tube(50, 30);
  const test::RestAndPose pair = test::tear_pose(test::tear_axes(mesh.points)[4].rest, 4);
  const Binding one({&pair.rest, 1}, mesh, continuous(1));
  std::vector<Vec3> expected(mesh.points.size()), out(mesh.points.size());
  one.update(pair.posed, expected);
  for (const int threads : {2, 3}) {
    const Binding other({&pair.rest, 1}, mesh, continuous(threads));
    other.update(pair.posed, out, threads);
    EXPECT_EQ(out, expected);
    EXPECT_EQ(other.report().ambiguous, one.report().ambiguous);
  }
  for (std::size_t i = 0; i < mesh.points.size(); i += 7) EXPECT_EQ(one.at(pair.posed, i), expected[i]);
}

/// Across the middle between the two legs of a U the nearest jumps from one to the other.
TEST(ContinuousBinding, DoesNotTearAcrossTheMiddleOfAU) {
  const test::Chain u = test::tear_axes(tube(10, 10).points)[3].rest;
  const test::RestAndPose pair = test::tear_pose(u, 0);
  const Vec3 a = u.points[2], b = u.points[u.points.size() - 3];
  double before[2] = {0.0, 0.0};
  for (const int count : {201, 401, 801, 1601}) {
    const PolygonMesh mesh = strip(line(a + Vec3(0.1, 0, 0.2), b + Vec3(0.2, 0, 0.3), count));
    std::vector<Vec3> out(mesh.points.size());
    double step[2];
    for (const BindMode mode : {BindMode::nearest, BindMode::continuous}) {
      const Binding binding({&pair.rest, 1}, mesh, {.mode = mode});
      binding.update(pair.posed, out);
      step[mode == BindMode::continuous] = longest_step(out);
    }
    EXPECT_GT(step[0], 1.0);
    if (count > 201) EXPECT_NEAR(step[1] / before[1], 0.5, 0.05) << count;
    before[1] = step[1];
  }
}

/// Two sheets: one at strand A; one nearest to strand B all over, with A within reach. A counts on the second
/// sheet only when a way over the mesh leads there from the first.
TEST(ContinuousBinding, RefusesAProjectionThatNoWayOverTheMeshLeadsTo) {
  const test::Chain u = test::tear_axes(tube(10, 10).points)[3].rest;
  const CurvePair rest = test::tear_pose(u, 0).rest;
  const Vec3 a = u.points[2], b = u.points[u.points.size() - 3];
  const std::vector<Vec3> lone = line(a + 0.53 * (b - a), a + 0.6 * (b - a), 30);
  const std::vector<Vec3> joined = line(a + 0.2 * (b - a), a + 0.6 * (b - a), 170);
  const double middle = 0.5 * (rest.knots().start() + rest.knots().end());
  const auto reaches_a = [&](const std::vector<Vec3>& points) {
    const PolygonMesh mesh = strip(points);
    const Binding binding({&rest, 1}, mesh, continuous());
    double most = 0.0;
    for (const Share& share : binding.shares(points.size() - 25))
      if (share.record.t < middle) most = std::max(most, share.weight);
    return std::pair(most, binding.report().gated.size());
  };
  EXPECT_EQ(reaches_a(lone).first, 0.0);
  EXPECT_GT(reaches_a(lone).second, 0u);
  EXPECT_GT(reaches_a(joined).first, 0.01);
  EXPECT_EQ(reaches_a(joined).second, 0u);
}

/// Three loops of the axis within a tube: strands that cross each other close to the mesh, jumps between
/// places close together, and foci.
TEST(ContinuousBinding, DoesNotTearAboutLoops) {
  const PolygonMesh mesh = tube(60, 40);
  const test::Chain loops = test::tear_axes(mesh.points)[4].rest;
  const CurvePair rest = test::tear_pose(loops, 0).rest;
  const TearJudge judge({&rest, 1}, mesh, continuous(), {.refinements = 1, .least_edges = 20000});
  for (int pose = 0; pose < test::kTearPoses; ++pose) {
    const CurvePair posed = test::tear_pose(loops, pose).posed;
    const JudgeReport report = judge.judge({&posed, 1});
    for (const double growth : report.growth) EXPECT_LE(growth, 1.1) << pose;
    EXPECT_LE(report.growth_of_max, 1.6) << pose;
  }
}

/// Beside a jump from one place to another close by, the nearest projection may have a part only as far as it
/// moves slowly.
TEST(ContinuousBinding, LeavesOutTheNearestWhereItMovesFast) {
  const PolygonMesh mesh = split_at_middles(tube(60, 60, 1.2, 1.2));
  const CurvePair rest = test::tear_pose(test::tear_axes(mesh.points)[4].rest, 0).rest;
  const Binding binding({&rest, 1}, mesh, continuous());
  double alone = 0.0, fastest = 0.0;
  for (std::size_t k = 0; k < mesh.corners.size(); ++k) {
    const std::uint32_t a = mesh.corners[k], b = mesh.corners[k % 3 < 2 ? k + 1 : k - 2];
    const Share in_a = binding.shares(a).front(), in_b = binding.shares(b).front();
    const double moved = (rest.primary().value(in_a.record.t) - rest.primary().value(in_b.record.t)).norm() /
                         (mesh.points[a] - mesh.points[b]).norm();
    alone = std::max(alone, moved);
    fastest = std::max(fastest, std::min(in_a.weight, in_b.weight) * moved);
  }
  EXPECT_GT(alone, 20.0);
  EXPECT_LT(fastest, 2.5);
}

/// An axis like an 8, whose strands pass each other at a small gap; a strip through the gap.
TEST(ContinuousBinding, StretchesNoMoreWhereStrandsPassCloser) {
  const auto steepest = [&](double gap) {
    test::Chain eight{{}, Vec3::UnitZ()};
    for (int k = 0; k <= 40; ++k) {
      const double a = std::numbers::pi * (1.8 * k / 40.0 - 0.4);
      eight.points.emplace_back(std::sin(a), 0.5 * std::sin(2 * a), 0.5 * gap * std::cos(a));
    }
    const test::RestAndPose pair = test::tear_pose(eight, 0);
    const PolygonMesh mesh = strip(line(Vec3(0.01, 0, -0.5), Vec3(0.01, 0, 0.5), 2001));
    std::vector<Vec3> out(mesh.points.size());
    Binding({&pair.rest, 1}, mesh, continuous()).update(pair.posed, out);
    return longest_step(out) / longest_step(mesh.points);
  };
  EXPECT_LT(steepest(0.04), steepest(0.2));
  EXPECT_LT(steepest(0.004), steepest(0.04));
}

/// A strip runs beside leg B of a U towards the bend. Leg A is within its reach, but no way over the mesh
/// leads there; nearer the bend the places between the legs are within reach, and A's with them.
TEST(ContinuousBinding, LetsInTheCurveBehindARefusedProjectionByDegrees) {
  const test::Chain u = test::tear_axes(tube(10, 10).points)[3].rest;
  const CurvePair rest = test::tear_pose(u, 0).rest;
  const double middle = 0.5 * (rest.knots().start() + rest.knots().end());
  const Vec3 a = u.points[7], b = u.points[u.points.size() - 8];
  const auto step = [&](int count) {
    const Vec3 from = a + 0.53 * (b - a);
    const PolygonMesh mesh = strip(line(from, from + Vec3(0.9, 0, 0), count));
    const Binding binding({&rest, 1}, mesh, continuous());
    EXPECT_GT(binding.report().gated.size(), mesh.points.size() / 2);
    std::vector<Vec3> part_of_a(mesh.points.size(), Vec3::Zero());
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      for (const Share& share : binding.shares(i))
        if (share.record.t < middle) part_of_a[i].x() += share.weight;
    EXPECT_EQ(part_of_a.front().x(), 0.0);
    EXPECT_GT(part_of_a.back().x(), 0.05);
    return longest_step(part_of_a);
  };
  EXPECT_NEAR(step(401) / step(201), 0.5, 0.05);
  EXPECT_NEAR(step(801) / step(401), 0.5, 0.05);
}

/// A body and a leg that starts at it, each with a curve-pair of its own.
TEST(ContinuousBinding, SharesAJunctionOfTwoCurvePairs) {
  const auto pair_of = [](const std::vector<Vec3>& p) { return test::pair_through(p, Vec3::UnitZ(), 0.3); };
  const std::vector<Vec3> body = line(Vec3(-3, 0, 0), Vec3(3, 0, 0), 8),
                          leg = line(Vec3(0, -0.1, 0), Vec3(0, -4, 0), 8);
  std::vector<Vec3> swung;
  for (const Vec3& p : leg) swung.emplace_back(-p.y() * 0.8, p.y() * 0.6, 0);
  const std::vector<CurvePair> rest{pair_of(body), pair_of(leg)}, posed{pair_of(body), pair_of(swung)};
  double before = 0.0;
  for (const int count : {401, 801, 1601}) {
    const PolygonMesh mesh = strip(line(Vec3(2, -0.4, 0.2), Vec3(0.3, -3, 0.2), count));
    const Binding binding(rest, mesh, continuous());
    std::vector<Vec3> out(mesh.points.size());
    binding.update(posed, out);
    EXPECT_LT(binding.report().rest_error, 1e-14);
    EXPECT_EQ(binding.pair_of(0), 0u);
    EXPECT_EQ(binding.pair_of(mesh.points.size() - 1), 1u);
    const double step = longest_step(out);
    if (before > 0.0) EXPECT_NEAR(step / before, 0.5, 0.1);  // that of a jump would stay
    before = step;
    MeshFollower(binding, 0, out).follow(0.0, posed);
    EXPECT_EQ(longest_step(out), step);
  }
}

TEST(ContinuousBinding, RefusesOptionsOutOfRange) {
  const PolygonMesh mesh = tube(4, 5);
  const CurvePair rest = test::tear_pose(test::tear_axes(mesh.points)[0].rest, 0).rest;
  for (const double band : {0.0, -1.0, 1.5, std::nan("")})
    EXPECT_THROW(Binding({&rest, 1}, mesh, {.mode = BindMode::continuous, .band = band}), InvalidInput);
  EXPECT_THROW(Binding(std::span<const CurvePair>(), mesh, continuous()), InvalidInput);
  EXPECT_THROW(Binding({&rest, 1}, mesh, continuous(0)), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
