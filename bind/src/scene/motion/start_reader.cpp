#include "scene/motion/start_reader.h"

#include "scene/json/names.h"

namespace tendril::scene {
namespace {

StartMotion read_start_motion(const JsonNode& node, const std::vector<std::string>& names) {
  StartMotion out;
  if (node.has("curve_pairs")) {
    const JsonNode list = node.at("curve_pairs");
    for (std::size_t k = 0; k < list.size(); ++k) out.curve_pairs.push_back(read_name(list.at(k), names));
  } else {
    for (std::size_t k = 0; k < names.size(); ++k) out.curve_pairs.push_back(k);
  }
  if (!node.has("velocity") && !node.has("spin")) node.refuse("no motion", "velocity or spin, or both");
  if (node.has("velocity")) out.velocity = node.at("velocity").vec3();
  if (node.has("spin")) out.spin = node.at("spin").vec3();
  if (node.has("about")) {
    if (!node.has("spin")) node.at("about").refuse("a point to spin about, without spin", "spin beside it");
    out.about = node.at("about").vec3();
  }
  return out;
}

}  // namespace

void read_start(const JsonNode& start, SceneFile& out) {
  out.start_place = start.pointer();
  out.start_at_equilibrium = start.text_or("from", "rest") == "equilibrium";
  if (!start.has("motions")) return;
  const JsonNode motions = start.at("motions");
  for (std::size_t k = 0; k < motions.size(); ++k) {
    out.start_motions.push_back(read_start_motion(motions.at(k), out.names));
    // A spin turns rods about themselves too.
    if (motions.at(k).has("spin")) out.scene.twist = Scene::Twist::everywhere;
  }
}

}  // namespace tendril::scene
