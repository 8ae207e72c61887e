#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/judge.h>
#include <tendril/curve/closest_point.h>

#include "bind/tear_cases.h"

namespace tendril::bind {
namespace {

/// A flat sheet in the plane z = 0, 4 long and 2 wide.
PolygonMesh sheet(int along, int across) {
  PolygonMesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k <= across; ++k) mesh.points.emplace_back(4.0 * i / along, 2.0 * k / across, 0.0);
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i * (across + 1) + k); };
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < across; ++k) {
      mesh.corners.insert(mesh.corners.end(), {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
  return mesh;
}

constexpr JudgeOptions kSmall{.refinements = 2, .least_edges = 20000, .limit = 20.0};

JudgeReport judged(BindMode mode, int axis, int pose) {
  const PolygonMesh mesh = sheet(40, 20);
  const test::RestAndPose pair =
      test::tear_pose(test::tear_axes(mesh.points)[static_cast<std::size_t>(axis)].rest, pose);
  return TearJudge({&pair.rest, 1}, mesh, {.mode = mode}, kSmall).judge({&pair.posed, 1});
}

TEST(TearJudge, SplitsATriangleInFour) {
  PolygonMesh mesh;
  mesh.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  mesh.corners = {0, 1, 2};
  mesh.face_begin = {0, 3};
  const PolygonMesh four = split_at_middles(mesh);
  EXPECT_EQ(four.points.size(), 6u);
  EXPECT_EQ(four.face_count(), 4u);
  double area = 0.0;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto face = four.face(f);
    area +=
        0.5 *
        (four.points[face[1]] - four.points[face[0]]).cross(four.points[face[2]] - four.points[face[0]]).z();
  }
  EXPECT_EQ(area, 2.0);
}

TEST(TearJudge, SeesTheTearOfNearestBindingGrowLikeALine) {
  const JudgeReport report = judged(BindMode::nearest, 3, 0);
  EXPECT_EQ(report.verdict, TearVerdict::tear);
  EXPECT_NEAR(report.growth_of_max, 2.0, 0.1);
  EXPECT_NEAR(report.exponent, 1.0, 0.15);
  ASSERT_EQ(report.levels.size(), 3u);
  EXPECT_GT(report.levels[0].edges, 20000u);
  EXPECT_EQ(report.worst.front().stretch, report.levels[0].max);
}

/// The cut locus between the two legs of the axis is the line in their middle, and beyond the bend a part of
/// the plane's medial axis: all tears lie on it, as exactly as halving finds it.
TEST(TearJudge, FindsWhereTheSheetIsTorn) {
  const JudgeReport report = judged(BindMode::nearest, 3, 0);
  EXPECT_EQ(report.verdict, TearVerdict::tear);
  EXPECT_GT(report.torn, 100u);
  ASSERT_EQ(report.tears.size(), 100u);
  const test::Chain legs = test::tear_axes(sheet(40, 20).points)[3].rest;
  const CurvePair rest = test::tear_pose(legs, 0).rest;
  const CurveProjector projector(rest.primary());
  for (const Tear& tear : report.tears) {
    EXPECT_GT(tear.gap, 1e-3 * std::sqrt(20.0));
    // Two places of the axis are nearest, or as near as each other: a step of the last piece apart.
    const double here = projector.nearest(tear.place).t;
    bool jumps = false;
    for (const double step : {-1e-7, 1e-7})
      for (const Vec3& along : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())})
        jumps |= std::abs(projector.nearest(tear.place + step * along).t - here) > 1e-3;
    EXPECT_TRUE(jumps) << tear.place.transpose();
  }
  EXPECT_TRUE(std::is_sorted(report.tears.begin(), report.tears.end(),
                             [](const Tear& a, const Tear& b) { return a.gap > b.gap; }));
}

/// A transition that the edges of the sheet do not resolve: its stretch grows with every split, as a tear's
/// does, but has a limit.
TEST(TearJudge, TellsATransitionTooFineForTheMeshFromATear) {
  const PolygonMesh mesh = sheet(40, 20);
  const test::RestAndPose pair = test::tear_pose(test::tear_axes(mesh.points)[3].rest, 0);
  const auto verdict = [&](BindMode mode) {
    return TearJudge({&pair.rest, 1}, mesh, {.mode = mode, .band = 0.02},
                     {.refinements = 1, .least_edges = 1000})
        .judge({&pair.posed, 1});
  };
  const JudgeReport smooth = verdict(BindMode::continuous);
  EXPECT_GT(smooth.growth_of_max, 1.8);
  EXPECT_EQ(smooth.verdict, TearVerdict::smooth);
  EXPECT_EQ(smooth.torn, 0u);
  EXPECT_TRUE(smooth.tears.empty());
  EXPECT_GT(smooth.steepest, 1.5 * smooth.levels.back().max);
  EXPECT_EQ(verdict(BindMode::nearest).verdict, TearVerdict::tear);
}

TEST(TearJudge, SaysBeforeItBindsHowMuch) {
  for (const int refinements : {1, 2})
    for (const std::size_t least : {std::size_t{100}, std::size_t{5000}}) {
      const JudgeOptions options{.refinements = refinements, .least_edges = least};
      const PolygonMesh mesh = sheet(16, 8);
      const CurvePair rest = test::tear_pose(test::tear_axes(mesh.points)[0].rest, 0).rest;
      const TearJudge judge({&rest, 1}, mesh, {}, options);
      const JudgeReport report = judge.judge({&rest, 1});
      const JudgeCost cost = judge_cost(mesh, options);
      EXPECT_EQ(cost.points, report.levels.back().points);
      EXPECT_EQ(cost.edges, report.levels.back().edges);
      EXPECT_EQ(judge.own_binding().size(), mesh.points.size());
    }
}

/// What is added by splits is bound as the points of a mesh that was split before.
TEST(TearJudge, BindsWhatItAddsAsAMeshOfItsOwn) {
  const PolygonMesh mesh = sheet(12, 6);
  const test::RestAndPose pair = test::tear_pose(test::tear_axes(mesh.points)[3].rest, 4);
  const TearJudge judge({&pair.rest, 1}, mesh, {}, {.refinements = 1, .least_edges = 1000});
  const JudgeReport report = judge.judge({&pair.posed, 1});
  const PolygonMesh fine = split_at_middles(judge.mesh());
  std::vector<Vec3> points(fine.points.size());
  Binding({&pair.rest, 1}, fine, {}).update({&pair.posed, 1}, points);
  double most = 0.0;
  for (std::size_t f = 0; f < fine.face_count(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = fine.face(f)[k], b = fine.face(f)[(k + 1) % 3];
      most = std::max(most, (points[a] - points[b]).norm() / (fine.points[a] - fine.points[b]).norm());
    }
  EXPECT_NEAR(report.levels.back().max, most, 1e-9 * most);
}

TEST(TearJudge, SeesNoTearInContinuousBinding) {
  const PolygonMesh mesh = sheet(40, 20);
  for (const std::size_t axis : {1U, 3U}) {
    const test::Chain chain = test::tear_axes(mesh.points)[axis].rest;
    const CurvePair rest = test::tear_pose(chain, 0).rest;
    // Fine enough to resolve the transition between the legs, which is a fortieth of the sheet wide.
    const TearJudge judge({&rest, 1}, mesh, {.mode = BindMode::continuous},
                          {.refinements = 1, .least_edges = 150000});
    for (int pose = 0; pose < test::kTearPoses; ++pose) {
      const CurvePair posed = test::tear_pose(chain, pose).posed;
      const JudgeReport report = judge.judge({&posed, 1});
      EXPECT_EQ(report.verdict, TearVerdict::smooth) << axis << ' ' << test::tear_pose_name(pose);
      for (const double growth : report.growth) EXPECT_LE(growth, 1.1) << axis << ' ' << pose;
      EXPECT_LE(report.growth_of_max, 1.6) << axis << ' ' << test::tear_pose_name(pose);
      EXPECT_LT(report.levels[1].rest_error, 1e-13 * 4.5);
    }
  }
}

TEST(TearJudge, FindsNothingInARigidMotion) {
  const PolygonMesh mesh = sheet(20, 10);
  const test::RestAndPose pair = test::tear_pose(test::tear_axes(mesh.points)[1].rest, 0);
  const auto moved = [](Points points) {
    std::vector<Vec3> out;
    for (const Vec3& p : points) out.push_back(rotate_about(Vec3::UnitY(), 0.7, p) + Vec3(1, 2, 3));
    return out;
  };
  const CurvePair posed(pair.rest.knots(), moved(pair.rest.primary().control_points()),
                        moved(pair.rest.orientation().control_points()));
  const JudgeReport report =
      TearJudge({&pair.rest, 1}, mesh, {.mode = BindMode::continuous}, kSmall).judge({&posed, 1});
  EXPECT_NEAR(report.levels[0].max, 1.0, 1e-9);
  EXPECT_EQ(report.levels[0].flipped, 0u);
  EXPECT_EQ(report.levels[0].beyond, 0u);
}

/// A curl tighter than the sheet is wide turns its inner side over.
TEST(TearJudge, CountsFolds) {
  EXPECT_EQ(judged(BindMode::nearest, 0, 0).levels[0].flipped, 0u);
  const PolygonMesh mesh = sheet(40, 20);
  const test::Chain straight = test::tear_axes(mesh.points)[0].rest;
  test::RestAndPose pair = test::tear_pose(straight, 0);
  std::vector<Vec3> posed(straight.points), sides;
  const double radius = 0.5;
  for (std::size_t i = 0; i < posed.size(); ++i) {
    const double a = (posed[i].x() - posed[0].x()) / radius;
    posed[i] = Vec3(radius * std::sin(a), 1.0 + radius * (1 - std::cos(a)), 0.0);
  }
  const Interpolator fit(3, straight.points);
  std::vector<Vec3> q = posed;
  for (Vec3& p : q) p.z() += 0.3;
  const CurvePair curled(fit.knots(), fit.solve(posed), fit.solve(q));
  const JudgeReport report =
      TearJudge({&pair.rest, 1}, mesh, {.mode = BindMode::nearest}, kSmall).judge({&curled, 1});
  const double share =
      static_cast<double>(report.levels[0].flipped) / static_cast<double>(report.levels[0].faces);
  EXPECT_NEAR(share, 0.25 * 0.9, 0.04);  // the half of one side that lies beyond the radius
}

TEST(TearJudge, RefusesWhatItCannotJudge) {
  const PolygonMesh mesh = sheet(2, 2);
  const CurvePair rest = test::tear_pose(test::tear_axes(mesh.points)[0].rest, 0).rest;
  EXPECT_THROW(TearJudge({&rest, 1}, mesh, {}, {.refinements = 0}), InvalidInput);
  EXPECT_THROW(TearJudge({&rest, 1}, mesh, {}, {.limit = 0.0}), InvalidInput);
  EXPECT_THROW(TearJudge({&rest, 1}, mesh, {}, {.least_gap = 0.0}), InvalidInput);
  EXPECT_THROW(judge_cost(mesh, {.refinements = 5}), InvalidInput);
  PolygonMesh points;
  points.points = mesh.points;
  EXPECT_THROW(TearJudge({&rest, 1}, points, {}, {}), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
