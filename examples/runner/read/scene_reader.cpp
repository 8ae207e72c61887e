#include "read/scene_reader.h"

#include "read/anchor_reader.h"
#include "read/curve_reader.h"
#include "read/force_reader.h"
#include "read/rod_reader.h"
#include "read/schema.h"

#include <tendril/base/file.h>
#include <tendril/dynamics/forces.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tendril::runner {
namespace {

constexpr std::size_t kMostFrames = 10000;

void read_curve_pairs(const JsonNode& list, SceneFile& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonNode one = list.at(i);
    const std::string name = one.text_or("name", "curve_pair_" + std::to_string(i));
    if (std::find(out.names.begin(), out.names.end(), name) != out.names.end()) {
      one.refuse("the name " + quote(name) + " is taken", "a name of its own");
    }
    out.names.push_back(name);
    out.scene.rods.push_back(read_rod(one));
    const Rod& rod = out.scene.rods.back();
    out.thickness.push_back(*std::max_element(rod.width.begin(), rod.width.end()));
    out.reach.push_back(one.has("reach") ? read_along(one, "reach") : std::vector<double>{});
  }
}

/// The child's root moves to its parent's node when its points are relative to it.
void place_child(const JsonNode& joint, Rod& child, const Vec3& root) {
  if (!joint.has("relative") || !joint.at("relative").value().get<bool>()) return;
  for (std::size_t i = 0; i < child.p.size(); ++i) {
    child.p[i] += root;
    child.q[i] += root;
  }
}

void stiffen_root(Rod& child, double factor) {
  child.bend_l.front() *= factor;
  child.bend_m.front() *= factor;
  child.bend_t.front() *= factor;
  child.twist.front() *= factor;
}

/// Parents come before their children in the list, so that relative points find them in place.
void read_joints(const JsonNode& list, SceneFile& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list.at(i).has("joint")) continue;
    const JsonNode node = list.at(i).at("joint");
    Joint joint;
    joint.child = i;
    joint.parent = read_name(node.at("curve_pair"), out.names);
    if (joint.parent >= i)
      node.at("curve_pair").refuse("not listed before this one", "an earlier curve-pair");
    joint.node = read_node(node.at("node"), out.scene.rods[joint.parent]);
    joint.reaction = !node.has("reaction") || node.at("reaction").value().get<bool>();
    place_child(node, out.scene.rods[i], out.scene.rods[joint.parent].p[joint.node]);
    if (node.has("stiffness")) stiffen_root(out.scene.rods[i], node.at("stiffness").positive());
    out.scene.joints.push_back(joint);
    out.joint_places.push_back(node.pointer());
  }
}

void read_all_anchors(const JsonNode& list, SceneFile& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list.at(i).has("anchors")) continue;
    const JsonNode anchors = list.at(i).at("anchors");
    for (std::size_t k = 0; k < anchors.size(); ++k) {
      const JsonNode anchor = anchors.at(k);
      for (const Anchor& a : anchor.locate([&] { return read_anchors(anchor, i, out.scene.rods[i]); })) {
        out.scene.anchors.push_back(a);
        out.anchor_places.push_back(anchor.pointer());
      }
    }
  }
}

void read_forces(const JsonNode& list, SceneFile& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    out.scene.forces.push_back(read_force(list.at(i), out.scene.rods, out.names));
    out.force_places.push_back(list.at(i).pointer());
  }
}

std::vector<double> read_outputs(const JsonNode& simulation, double duration) {
  if (simulation.has("output_every") && simulation.has("frames")) {
    simulation.refuse("output_every and frames", "one of them, not both");
  }
  std::vector<double> outputs{0.0};
  if (simulation.has("output_every")) {
    const JsonNode every = simulation.at("output_every");
    const double step = every.positive();
    const double count = std::floor(duration / step * (1.0 + 1e-12));
    if (count + 1 > static_cast<double>(kMostFrames)) {
      every.refuse("more than " + std::to_string(kMostFrames) + " frames in the run", "a larger step");
    }
    for (int k = 1; k <= static_cast<int>(count); ++k) outputs.push_back(std::min(k * step, duration));
    return outputs;
  }
  const long frames = simulation.has("frames") ? simulation.at("frames").integer(2, kMostFrames) : 101;
  for (long k = 1; k < frames; ++k) {
    outputs.push_back(duration * static_cast<double>(k) / static_cast<double>(frames - 1));
  }
  return outputs;
}

/// A method that chooses its own steps is given none; every other one needs one.
void read_method(const JsonNode& simulation, SimulationOptions& options) {
  const std::string name = simulation.text_or("method", to_string(options.method));
  const MethodInfo* row = find_method(name);
  if (row == nullptr) {
    std::string known;
    for (const MethodInfo& one : methods())
      known += (known.empty() ? "one of: \"" : ", \"") + std::string(one.name) + '"';
    simulation.at("method").refuse('"' + name + "\" is not one of the choices", known);
  }
  options.method = row->method;
  if (!chooses_steps(options.method)) {
    options.fixed_step = simulation.at("fixed_step").positive();
  } else if (simulation.has("fixed_step")) {
    simulation.at("fixed_step")
        .refuse("a step for " + name, "a method of fixed step: " + name + " chooses its own");
  }
}

void read_simulation(const JsonNode& simulation, SceneFile& out) {
  out.duration = simulation.at("duration").positive();
  out.outputs = read_outputs(simulation, out.duration);
  SimulationOptions& options = out.options;
  options.tolerance = simulation.number_or("tolerance", options.tolerance);
  read_method(simulation, options);
  if (simulation.has("degree"))
    options.degree = static_cast<int>(simulation.at("degree").integer(1, kMaxDegree));
  options.parametrisation = read_parametrisation(simulation);
  if (simulation.has("work_limit")) options.work_limit = simulation.at("work_limit").integer(1, 1L << 52);
}

/// Up is against gravity, where the scene does not say.
void choose_up(const JsonNode& file, ViewOptions& view) {
  if (!file.has("forces")) return;
  for (std::size_t i = 0; i < file.at("forces").size(); ++i) {
    const JsonNode force = file.at("forces").at(i);
    if (!force.has("acceleration") || !(force.at("acceleration").vec3().stableNorm() > 0.0)) continue;
    view.up = -force.at("acceleration").vec3().stableNormalized();
    return;
  }
}

void read_picture(const JsonNode& picture, SceneFile& out) {
  ViewOptions& view = out.view;
  if (picture.has("up")) {
    const Vec3 up = picture.at("up").vec3();
    if (!(up.stableNorm() > 0.0)) picture.at("up").refuse("no direction", "a vector that is not zero");
    view.up = up.stableNormalized();
  }
  view.yaw = picture.number_or("yaw", view.yaw);
  view.pitch = picture.number_or("pitch", view.pitch);
  if (picture.has("size")) {
    view.width = static_cast<int>(picture.at("size").at(0).integer(16, 8192));
    view.height = static_cast<int>(picture.at("size").at(1).integer(16, 8192));
  }
  if (picture.has("samples")) view.samples = static_cast<int>(picture.at("samples").integer(1, 1024));
  if (picture.has("panels")) out.panels = static_cast<int>(picture.at("panels").integer(1, 100));
  if (picture.has("axis")) out.draw_axis = picture.at("axis").value().get<bool>();
}

std::string beside(const std::string& scene, const std::string& relative) {
  return (std::filesystem::path(scene).parent_path() / relative).lexically_normal().string();
}

void read_mesh_name(const JsonNode& file, SceneFile& out) {
  if (file.has("mesh")) {
    const std::string name = file.at("mesh").text();
    if (name.empty()) file.at("mesh").refuse("an empty path", "the path of a mesh, or null");
    out.mesh = beside(out.path, name);
  }
}

/// The curve-pairs named; or else the first and all that are joined to it, one way or another.
void read_bound_to(const JsonNode& file, SceneFile& out) {
  if (!file.has("bound_to")) {
    std::vector<bool> joined(out.names.size(), false);
    joined[0] = true;
    for (const Joint& joint : out.scene.joints) joined[joint.child] = joined[joint.parent];
    for (std::size_t k = 0; k < joined.size(); ++k)
      if (joined[k]) out.bound_to.push_back(k);
    return;
  }
  const JsonNode names = file.at("bound_to");
  if (!names.is_array()) {
    out.bound_to = {read_name(names, out.names)};
    return;
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::size_t pair = read_name(names.at(k), out.names);
    if (std::find(out.bound_to.begin(), out.bound_to.end(), pair) != out.bound_to.end())
      names.at(k).refuse("named twice", "different curve-pairs");
    out.bound_to.push_back(pair);
  }
}

}  // namespace

SceneFile read_scene(const std::string& path) {
  const Json json = parse_json(read_file(path), path);
  require_schema(json, kSceneSchema, path);
  const JsonNode file(path, json);
  SceneFile out;
  out.path = path;
  if (file.has("units")) out.units = file.at("units").value();
  read_curve_pairs(file.at("curve_pairs"), out);
  read_joints(file.at("curve_pairs"), out);
  read_all_anchors(file.at("curve_pairs"), out);
  read_mesh_name(file, out);
  read_bound_to(file, out);
  if (file.has("forces")) read_forces(file.at("forces"), out);
  if (file.text_or("twist", "where_needed") == "everywhere") out.scene.twist = Scene::Twist::everywhere;
  read_simulation(file.at("simulation"), out);
  choose_up(file, out.view);
  if (file.has("picture")) read_picture(file.at("picture"), out);
  return out;
}

InvalidInput in_scene(const SceneFile& file, const InvalidInput& error) {
  const std::string& place = error.place();
  const auto index_after = [&](const char* name) -> std::size_t {
    const std::string head = std::string(name) + "[";
    return place.rfind(head, 0) == 0 ? std::stoul(place.substr(head.size())) : std::string::npos;
  };
  std::string pointer;
  if (const std::size_t rod = index_after("rods"); rod != std::string::npos) {
    pointer = "/curve_pairs/" + std::to_string(rod);
  } else if (const std::size_t j = index_after("joints"); j < file.joint_places.size()) {
    pointer = file.joint_places[j];
  } else if (const std::size_t a = index_after("anchors"); a < file.anchor_places.size()) {
    pointer = file.anchor_places[a];
  } else if (const std::size_t f = index_after("forces"); f < file.force_places.size()) {
    pointer = file.force_places[f];
  }
  return {file.path + "#" + pointer, place + ": " + error.reason(), error.expected()};
}

}  // namespace tendril::runner
