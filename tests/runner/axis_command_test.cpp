#include <gtest/gtest.h>
#include <tendril/bind/export.h>

#include <nlohmann/json.hpp>

#include "axis/shapes.h"
#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

TEST(AxisCommand, TwoRunsWriteTheSameBytes) {
  const Folder folder;
  bind::write_mesh(folder / "y.off", three_tubes());
  // The addresses that CGAL would sort by are others in each run, all the more after another environment.
  ASSERT_EQ(folder.run("axis y.off --out one.json").code, 0);
  setenv("TENDRIL_TEST_PADDING", std::string(5000, 'x').c_str(), 1);
  const Outcome again = folder.run("axis y.off --out two.json");
  unsetenv("TENDRIL_TEST_PADDING");
  ASSERT_EQ(again.code, 0) << again.err;
  const std::string one = bytes_of(folder / "one.json");
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(one, bytes_of(folder / "two.json"));
}

TEST(AxisCommand, WritesWhatBindAndDeformRead) {
  const Folder folder;
  bind::write_mesh(folder / "y.off", three_tubes());
  const Outcome found = folder.run("axis y.off --out a.json --json --picture a.png");
  ASSERT_EQ(found.code, 0) << found.err;
  const Json report = Json::parse(found.out);
  EXPECT_EQ(report.at("status"), "found");
  EXPECT_EQ(report.at("curves").size(), 2U);
  EXPECT_EQ(report.at("curves").at(1).at("joint").at("curve_pair"), "axis");
  EXPECT_EQ(bytes_of(folder / "a.png").substr(1, 3), "PNG");
  const Outcome bound = folder.run("bind y.off --axis a.json --json");
  ASSERT_EQ(bound.code, 0) << bound.err;
  EXPECT_LT(Json::parse(bound.out).at("binding").at("rest_error").get<double>(), 1e-14);
  const Outcome deformed = folder.run("deform y.off --axis a.json --pose a.json --out same.off --json");
  ASSERT_EQ(deformed.code, 0) << deformed.err;
  EXPECT_LT(Json::parse(deformed.out).at("rest_error").get<double>(), 1e-14);
}

/// What it found is written all the same: a person may go on from it.
TEST(AxisCommand, SaysWhereSkinHasNoAxisNear) {
  const Folder folder;
  bind::write_mesh(folder / "y.off", three_tubes());
  const Outcome found = folder.run("axis y.off --out a.json --prune 20 --json");
  EXPECT_EQ(found.code, 1);
  EXPECT_NE(found.err.find("uncovered: 21 % of the skin"), std::string::npos) << found.err;
  EXPECT_EQ(Json::parse(found.out).at("status"), "uncovered");
  EXPECT_GT(bytes_of(folder / "a.json").size(), 100U);
}

TEST(AxisCommand, APoseMustHaveAsManyCurves) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  folder.write("one.json",
               R"({"version": 1, "degree": 1, "points": [[0,0,0],[0,1,0]], "orientation": [1,0,0]})");
  folder.write("two.json", R"({"version": 1, "curves": [
    {"degree": 1, "points": [[0,0,0],[0,1,0]], "orientation": [1,0,0]},
    {"name": "b", "degree": 1, "points": [[0,0,0],[0,1,1]], "orientation": [1,0,0]}]})");
  folder.write("mixed.json", R"({"version": 1, "degree": 2, "curves": [
    {"points": [[0,0,0],[0,1,0]], "orientation": [1,0,0]}]})");
  EXPECT_EQ(folder.run("deform tube.off --axis two.json --pose two.json --out o.ply").code, 0);
  const Outcome refused = folder.run("deform tube.off --axis two.json --pose one.json --out o.ply");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("one.json#: 1 curve-pairs"), std::string::npos) << refused.err;
  EXPECT_EQ(folder.run("bind tube.off --axis mixed.json").code, 2);
}

TEST(AxisCommand, RefusesAMeshThatIsNotClosed) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  const Outcome open = folder.run("axis tube.off --out a.json");
  EXPECT_EQ(open.code, 2);
  EXPECT_NE(open.err.find("tube.off: 2 hole(s)"), std::string::npos) << open.err;
  EXPECT_NE(open.err.find("--close"), std::string::npos) << open.err;
  const Outcome closed = folder.run("axis tube.off --out a.json --close");
  EXPECT_EQ(closed.code, 0) << closed.err;
  const Outcome late = folder.run("axis tube.off --out b.json --close --time-limit 1e-4");
  EXPECT_EQ(late.code, 1);
  EXPECT_NE(late.err.find("time_limit"), std::string::npos) << late.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "b.json"));
}

}  // namespace
}  // namespace tendril::test
