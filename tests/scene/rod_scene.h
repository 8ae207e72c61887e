#pragma once

#include <tendril/scene/scene_file.h>

#include <nlohmann/json.hpp>

namespace tendril::test {

constexpr double kRodRadius = 0.01;

/// A scene of one rod of radius kRodRadius and nine nodes, on a line of points; it has no `simulation` yet.
inline nlohmann::json rod_scene(const char* points, double young) {
  nlohmann::json scene = nlohmann::json::parse(R"({
    "version": 1,
    "curve_pairs": [{"name": "rod", "nodes": 9, "orientation": [0, 1, 0],
      "material": {"poisson": 0.35, "density": 1000},
      "section": {"type": "circular", "radius": 0.01}}]
  })");
  scene["curve_pairs"][0]["points"] = nlohmann::json::parse(points);
  scene["curve_pairs"][0]["material"]["young"] = young;
  return scene;
}

/// Gravity along -z.
inline void let_fall(nlohmann::json& scene) {
  scene["forces"] = nlohmann::json::parse(R"([{"type": "gravity", "acceleration": [0, 0, -9.81]}])");
}

inline scene::SceneFile parsed(const nlohmann::json& scene) {
  return scene::parse_scene(scene.dump(1), "scene.json");
}

}  // namespace tendril::test
