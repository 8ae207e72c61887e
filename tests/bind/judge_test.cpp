#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/judge.h>

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
  PolygonMesh points;
  points.points = mesh.points;
  EXPECT_THROW(TearJudge({&rest, 1}, points, {}, {}), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
