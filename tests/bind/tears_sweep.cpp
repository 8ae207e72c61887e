#include <gtest/gtest.h>
#include <tendril/bind/import.h>
#include <tendril/bind/judge.h>

#include <cstdio>

#include "bind/tear_cases.h"

// Ten meshes, five axes, five poses: nearest binding and continuous binding side by side, judged by
// refinement.
namespace tendril::bind {
namespace {

class EveryMesh : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, EveryMesh,
                         testing::Values("diplodocus.off", "armadillo.off", "elephant.off", "cactus.off",
                                         "camel.off", "dino.off", "bear.off", "knot1.off", "hand.off",
                                         "triceratops.off"));

void print(const std::string& axis, int pose, const char* mode, const JudgeReport& report) {
  const JudgeLevel &first = report.levels.front(), &last = report.levels.back();
  std::printf(
      "  %-9s %-12s %-10s ambiguous %5.2f %%  p99.9 %6.1f -> %6.1f  p99.99 %6.1f -> %6.1f  max %6.1f -> %7.1f"
      "  growth %.2f, max %.2f  exponent %.2f  %s\n",
      axis.c_str(), test::tear_pose_name(pose), mode,
      100.0 * static_cast<double>(first.ambiguous) / static_cast<double>(first.points), first.quantile[3],
      last.quantile[3], first.quantile[4], last.quantile[4], first.max, last.max, report.growth[4],
      report.growth_of_max, report.exponent, report.verdict == TearVerdict::tear ? "tear" : "smooth");
}

/// Not even the absurd axis, three loops within the mesh, may tear it.
TEST_P(EveryMesh, DoesNotTear) {
  const PolygonMesh mesh = read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + GetParam());
  std::printf("%s\n", GetParam());
  bool nearest_tears = false;
  for (const test::AxisCase& axis : test::tear_axes(mesh.points)) {
    const CurvePair rest = test::tear_pose(axis.rest, 0).rest;
    const JudgeOptions fine{.refinements = 2, .least_edges = 100000};
    const TearJudge nearest({&rest, 1}, mesh, {.mode = BindMode::nearest}, fine),
        continuous({&rest, 1}, mesh, {.mode = BindMode::continuous}, fine);
    for (int pose = 0; pose < test::kTearPoses; ++pose) {
      const CurvePair posed = test::tear_pose(axis.rest, pose).posed;
      const JudgeReport beside = nearest.judge({&posed, 1});
      print(axis.name, pose, "nearest", beside);
      nearest_tears |= beside.verdict == TearVerdict::tear;
      const JudgeReport report = continuous.judge({&posed, 1});
      print(axis.name, pose, "continuous", report);
      EXPECT_EQ(report.verdict, TearVerdict::smooth) << axis.name << pose;
      for (const double growth : report.growth) EXPECT_LE(growth, 1.1) << axis.name << pose;
      EXPECT_LE(report.growth_of_max, 1.65) << axis.name << pose;  // of a tear 2 and more
      EXPECT_LE(report.levels.back().rest_error, 1e-13 * bounding_diagonal(mesh.points));
    }
  }
  EXPECT_TRUE(nearest_tears);
}

}  // namespace
}  // namespace tendril::bind
