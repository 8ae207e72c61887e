#include <gtest/gtest.h>
#include <tendril/scene/queries.h>
#include <tendril/scene/scene_error.h>

namespace tendril::scene {
namespace {

TEST(Queries, AreReadInTheFilesOrder) {
  const Queries q = parse_queries(R"({"version": 1,
    "points": [[1, 2, 3], [4, 5, 6]],  // of two
    "balls": [{"centre": [1, 0, 0], "radius": 0.5}, {"radius": 2, "centre": [0, 1, 0]}],
    "segments": [[[1, 2, 3], [4, 5, 6]]],
    "triangles": [[[1, 2, 3], [4, 5, 6], [7, 8, 9]]]})",
                                  "q.json");
  ASSERT_EQ(q.points.size(), 2U);
  EXPECT_EQ(q.points[1], Vec3(4, 5, 6));
  ASSERT_EQ(q.balls.size(), 2U);
  EXPECT_EQ(q.balls[0].centre, Vec3(1, 0, 0));
  EXPECT_EQ(q.balls[0].radius, 0.5);
  EXPECT_EQ(q.balls[1].radius, 2.0);
  ASSERT_EQ(q.segments.size(), 1U);
  EXPECT_EQ(q.segments[0][0], Vec3(1, 2, 3));
  EXPECT_EQ(q.segments[0][1], Vec3(4, 5, 6));
  ASSERT_EQ(q.triangles.size(), 1U);
  EXPECT_EQ(q.triangles[0][0], Vec3(1, 2, 3));
  EXPECT_EQ(q.triangles[0][1], Vec3(4, 5, 6));
  EXPECT_EQ(q.triangles[0][2], Vec3(7, 8, 9));
}

TEST(Queries, MayBeOfOneKindAlone) {
  EXPECT_EQ(
      parse_queries(R"({"version": 1, "segments": [[[0, 0, 0], [0, 0, 0]]]})", "q.json").segments.size(), 1U);
  EXPECT_EQ(parse_queries(R"({"version": 1, "points": [], "balls": [{"centre": [0, 0, 0], "radius": 1}]})",
                          "q.json")
                .balls.size(),
            1U);
}

TEST(Queries, AreRefusedWithTheirLine) {
  try {
    parse_queries("{\"version\": 1,\n \"balls\": [\n  {\"centre\": [0, 0, 0], \"radius\": 0}]}", "q.json");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(error.place(), "q.json#/balls/0/radius");
    EXPECT_EQ(error.at().line, 3U);
    EXPECT_EQ(error.expected(), "a positive number");
  }
  EXPECT_THROW(parse_queries(R"({"version": 1})", "q.json"), SceneError);
  EXPECT_THROW(parse_queries(R"({"version": 2, "points": [[0, 0, 0]]})", "q.json"), SceneError);
}

}  // namespace
}  // namespace tendril::scene
