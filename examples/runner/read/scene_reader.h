#pragma once

#include "draw/view.h"
#include "read/json_reader.h"

#include <tendril/dynamics/simulation.h>

#include <optional>

namespace tendril::runner {

/// Everything a scene file says, checked, with the library's own types filled in.
struct SceneFile {
  std::string path;
  Scene scene;
  Json units;                              ///< as given, or null
  std::vector<std::string> names;          ///< of the curve-pairs
  std::vector<double> thickness;           ///< of the curve-pairs, to draw them where there is no mesh
  std::vector<std::vector<double>> reach;  ///< per curve-pair and node; empty where everything is reached
  std::vector<std::string> joint_places;   ///< JSON pointer of each joint of the scene
  std::vector<std::string> anchor_places;  ///< of each anchor
  std::vector<std::string> force_places;   ///< and of each force
  std::string mesh;                        ///< path, made relative to where the program runs; empty for none
  std::vector<std::size_t> bound_to;       ///< curve-pairs that the mesh follows, at least one
  SimulationOptions options;
  double duration = 0.0;
  std::vector<double> outputs;  ///< ascending, from time 0
  ViewOptions view;
  int panels = 12;
  bool draw_axis = false;
};

/// Reads and checks a scene file against scene.schema.json and beyond. Throws InvalidInput ("name#/pointer"
/// or "name:line:column") or FileError. The mesh is not opened.
SceneFile read_scene(const std::string& path);

/// What the library says of `rods[i]`, `joints[i]`, `anchors[i]` or `forces[i]`, said of the scene file.
InvalidInput in_scene(const SceneFile& file, const InvalidInput& error);

}  // namespace tendril::runner
