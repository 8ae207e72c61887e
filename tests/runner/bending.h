#pragma once

#include <nlohmann/json.hpp>

#include "runner/program.h"

/// Scenes that bend and twist the tube far.
namespace tendril::test {

/// A soft stem that falls over to its side and winds up.
inline nlohmann::json bending() {
  using Json = nlohmann::json;
  Json scene = Json::parse(full_scene());
  scene["curve_pairs"][0]["material"]["young"] = 4e4;
  scene["curve_pairs"][0]["nodes"] = 9;
  scene["forces"] = Json::array({{{"type", "gravity"}, {"acceleration", {6, -9.81, 2}}},
                                 {{"type", "torque"},
                                  {"curve_pair", "stem"},
                                  {"node", -1},
                                  {"direction", {0, 1, 0}},
                                  {"signal", 0.2}}});
  scene["picture"]["up"] = {0, 1, 0};  // else against gravity
  scene["simulation"]["duration"] = 0.6;
  scene["simulation"]["frames"] = 13;
  return scene;
}

/// Wound up by more than half a turn, beyond what orientation curves show; and its end is out of reach.
inline nlohmann::json wound() {
  nlohmann::json scene = bending();
  scene["curve_pairs"][0]["nodes"] = 5;
  scene["curve_pairs"][0]["reach"] = {1.0, 1.0, 0.1};
  scene["forces"] = nlohmann::json::array(
      {{{"type", "torque"}, {"curve_pair", "stem"}, {"node", -1}, {"direction", {0, 1, 0}}, {"signal", 8}}});
  return scene;
}

/// The same tube on two stems side by side, of which one is softer: what is between them follows both.
inline nlohmann::json forked() {
  using Json = nlohmann::json;
  Json scene = bending();
  Json left = scene["curve_pairs"][0], right = left;
  left["name"] = "left", right["name"] = "right";
  for (Json& p : left["points"]) p[0] = p[2] = -0.05;
  for (Json& p : right["points"]) p[0] = p[2] = 0.05;
  right["material"]["young"] = 1e5;
  for (Json* stem : {&left, &right}) stem->erase("reach");
  scene["curve_pairs"] = {left, right};
  scene["bound_to"] = {"left", "right"};
  scene["forces"].erase(1);
  return scene;
}

/// The name of a run's frame.
inline std::string frame_name(std::size_t moment) {
  const std::string number = std::to_string(moment);
  return "frame_" + std::string(4 - number.size(), '0') + number + ".ply";
}

/// Runs a scene and leaves its page as NAME.html.
inline void make_page(const Folder& folder, const std::string& name, const nlohmann::json& scene,
                      const std::string& mesh) {
  folder.write("tube.off", mesh);
  folder.write(name + ".json", scene.dump());
  const Outcome run = folder.run("run " + name + ".json --out " + name + " --double --no-pictures --player");
  ASSERT_EQ(run.code, 0) << run.err;
}

/// Whether a command of the shell does well.
inline bool does(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace tendril::test
