#include "scene/json/line_of.h"
#include "scene/json/names.h"
#include "scene/json/schema.h"
#include "scene/motion/start_reader.h"
#include "scene/read/anchor_reader.h"
#include "scene/read/contact_reader.h"
#include "scene/read/force_reader.h"
#include "scene/read/rod_reader.h"
#include "scene/read/simulation_reader.h"

#include <tendril/base/file.h>
#include <tendril/scene/scene_file.h>

#include <algorithm>
#include <optional>

namespace tendril::scene {
namespace {

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
  const std::optional<Units> units = units_of(out.units);
  for (std::size_t i = 0; i < list.size(); ++i) {
    out.scene.forces.push_back(read_force(list.at(i), out.scene.rods, out.names, units));
    out.force_places.push_back(list.at(i).pointer());
  }
}

void read_mesh_name(const JsonNode& file, SceneFile& out) {
  if (file.has("mesh")) out.mesh = file.at("mesh").path();
}

/// The curve-pairs named; or else the first and all that are joined to it, one way or another.
void read_bound_to(const JsonNode& file, SceneFile& out) {
  if (!file.has("bound_to")) {
    out.bound_by_default = true;
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

void read_units(const JsonNode& file, SceneFile& out) {
  if (!file.has("units")) return;
  for (const char* what : {"length", "mass", "time"})
    if (file.at("units").has(what)) out.units[what] = file.at("units").at(what).text();
}

/// The number in "rods[3]: ...", where the place is about rods.
std::optional<std::size_t> index_of(const std::string& place, const std::string& what) {
  const std::string head = what + "[";
  if (place.rfind(head, 0) != 0) return std::nullopt;
  return std::stoul(place.substr(head.size()));
}

/// The part of the file that a place in the library's words is about; empty where it is about all of it.
std::string pointer_of(const SceneFile& file, const std::string& place) {
  if (const auto rod = index_of(place, "rods")) return "/curve_pairs/" + std::to_string(*rod);
  if (place == "start") return file.start_place;
  if (place.rfind("contact", 0) == 0)
    for (const MeshForce* of_mesh : {&file.mesh_contact, &file.mesh_self_contact})
      if (of_mesh->make) return of_mesh->place;
  if (place.rfind("contact", 0) == 0 && file.contact) return file.force_places[*file.contact];
  if (const auto body = index_of(place, "bodies"))
    for (const SceneBody& one : file.bodies)
      if (one.free == body) return one.pointer;
  const auto entry = [&](const char* what, const std::vector<std::string>& places) -> std::string {
    const auto index = index_of(place, what);
    return index && *index < places.size() ? places[*index] : "";
  };
  for (const std::string& pointer : {entry("joints", file.joint_places), entry("anchors", file.anchor_places),
                                     entry("forces", file.force_places)})
    if (!pointer.empty()) return pointer;
  for (const char* what : {"until", "outputs", "tolerance", "fixed_step", "degree", "work_limit"})
    if (place.rfind(what, 0) == 0) return "/simulation";
  return "";
}

SceneFile read_text(std::string_view text, const std::string& name) {
  const Json json = parse_json(text, name);
  require_schema(json, kSceneSchema, name);
  const JsonNode file(name, json);
  SceneFile out;
  out.path = name;
  out.text = text;
  read_units(file, out);
  read_curve_pairs(file.at("curve_pairs"), out);
  read_joints(file.at("curve_pairs"), out);
  read_all_anchors(file.at("curve_pairs"), out);
  read_mesh_name(file, out);
  read_bound_to(file, out);
  if (file.has("forces")) read_forces(file.at("forces"), out);
  if (file.text_or("twist", "where_needed") == "everywhere") out.scene.twist = Scene::Twist::everywhere;
  if (file.has("start")) read_start(file.at("start"), out);
  read_simulation(file.at("simulation"), out);
  read_contact(file, out);
  if (file.has("statics")) read_statics(file.at("statics"), out);
  read_picture(file, out);
  return out;
}

}  // namespace

SceneFile parse_scene(std::string_view text, const std::string& name) {
  return with_lines(text, [&] { return read_text(text, name); });
}

SceneFile read_scene(const std::string& path) {
  return parse_scene(read_file(path), path);
}

SceneError in_scene(const SceneFile& file, const InvalidInput& error) {
  if (const auto* already = dynamic_cast<const SceneError*>(&error)) return *already;
  const std::string pointer = pointer_of(file, error.place());
  const std::string reason = error.place() + ": " + error.reason();
  return {{file.path, pointer, line_of(file.text, pointer)}, reason, error.expected()};
}

System make_bare_system(const SceneFile& file) {
  try {
    System system(file.scene);
    const State rest = system.rest_state();
    return system;
  } catch (const InvalidInput& error) {
    throw in_scene(file, error);
  }
}

System make_system(const SceneFile& file) {
  for (const MeshForce* of_mesh : {&file.mesh_contact, &file.mesh_self_contact})
    if (of_mesh->make && !of_mesh->force)
      throw SceneError({file.path, of_mesh->place, line_of(file.text, of_mesh->place)},
                       "contact of a mesh that is not bound",
                       "a run of a scene with a mesh; or contact of rods");
  return make_bare_system(file);
}

}  // namespace tendril::scene
