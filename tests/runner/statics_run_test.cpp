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

}  // namespace
}  // namespace tendril::test
