#include "runner/program.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// A rod of unit length clamped at both ends, one of which comes nearer and turns by two turns.
Json twisted_scene() {
  return Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "rod", "points": [[0, 0, 0], [1, 0, 0]], "nodes": 21, "orientation": [0, 1, 0],
       "springs": {"stretch": 2e4, "bend_l": 0, "bend_m": 0, "bend_t": 40, "twist": 20, "mass": 0.05, "inertia": 1e-4},
       "anchors": [{"node": 0},
                   {"node": -1, "translation": {"velocity": [-0.05, 0, 0]},
                    "rotation": {"axis": [1, 0, 0], "rate": 12.566370614359172}}]}],
    "simulation": {"duration": 1}
  })");
}

TEST(Statics, FollowsAnEndThatTurnsAndSaysHowItStands) {
  const Folder folder;
  folder.write("scene.json", twisted_scene().dump());
  const Outcome outcome = folder.run("statics scene.json --out out --json --no-pictures");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json summary = Json::parse(outcome.out);
  EXPECT_EQ(summary.at("status"), "converged");
  EXPECT_EQ(summary.at("time"), 1.0);
  EXPECT_EQ(summary.at("stability").at("unstable_directions"), 0);
  EXPECT_GT(summary.at("unstable_branches_left").get<int>(), 0);
  EXPECT_LT(summary.at("residual").get<double>(), 1e-6);
  const std::string masses = bytes_of(folder / "out/trajectory.csv");
  EXPECT_EQ(std::count(masses.begin(), masses.end(), '\n'), 1 + 21);
  EXPECT_EQ(Json::parse(bytes_of(folder / "out/summary.json")).at("files"), Json::array({"trajectory.csv"}));
}

TEST(Statics, SaysWhyItFailsAndRefusesHalfAMotion) {
  const Folder folder;
  Json scene = twisted_scene();
  folder.write("scene.json", scene.dump());
  const Outcome limited = folder.run("statics scene.json --work-limit 3");
  EXPECT_EQ(limited.code, 1);
  EXPECT_NE(limited.err.find("work_limit"), std::string::npos) << limited.err;
  scene["curve_pairs"][0]["anchors"][1]["rotation"]["amplitude"] = 1.0;
  folder.write("scene.json", scene.dump());
  const Outcome refused = folder.run("statics scene.json");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("/curve_pairs/0/anchors/1/rotation"), std::string::npos) << refused.err;
}

/// A bar held at one point hangs down, a free one is held by nothing, and the scene says where loads begin.
TEST(Statics, FollowsWhatNothingResistsOrNamesIt) {
  const Folder folder;
  Json scene = Json::parse(R"({
    "version": 1,
    "curve_pairs": [
      {"name": "bar", "points": [[0, 0, 0], [1, 0, 0]], "nodes": 9, "orientation": [0, 0, 1],
       "material": {"young": 2e11, "poisson": 0.3, "density": 7850}, "section": {"type": "circular", "radius": 0.01},
       "anchors": [{"node": 0, "hold": "position"}]}],
    "forces": [{"type": "gravity", "acceleration": [0, -9.81, 0]}],
    "statics": {"first_load": 0.5},
    "simulation": {"duration": 1}
  })");
  folder.write("scene.json", scene.dump());
  const Outcome hung = folder.run("statics scene.json --out out --json --no-pictures");
  ASSERT_EQ(hung.code, 0) << hung.err;
  const Json summary = Json::parse(hung.out);
  EXPECT_LE(summary.at("residual").get<double>(), 1e-9);
  const double depth = -summary.at("energy").at("potential").get<double>() /
                       summary.at("supports")[0].at("force")[1].get<double>();
  EXPECT_NEAR(depth, 0.5, 1e-6);  // of the centre of mass
  const Outcome never = folder.run("statics scene.json --first-load 2 --load 2 --work-limit 1");
  EXPECT_NE(never.err.find("at load 2"), std::string::npos) << never.err;
  scene["curve_pairs"][0].erase("anchors");
  folder.write("scene.json", scene.dump());
  const Outcome falling = folder.run("statics scene.json");
  EXPECT_EQ(falling.code, 1);
  EXPECT_NE(falling.err.find("unheld: at load 0.5"), std::string::npos) << falling.err;
  EXPECT_NE(falling.err.find("nothing holds rod 0"), std::string::npos) << falling.err;
}

}  // namespace
}  // namespace tendril::test
