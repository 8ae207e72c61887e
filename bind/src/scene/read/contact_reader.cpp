#include "scene/read/contact_reader.h"

#include "scene/read/anchor_reader.h"
#include "scene/solid/contact_stiffness.h"
#include "scene/solid/known_speed.h"
#include "scene/solid/solid_reader.h"

#include <tendril/contact/body_contact.h>
#include <tendril/contact/rod_contact.h>
#include <tendril/contact/rod_rod_contact.h>
#include <tendril/contact/surface_contact.h>
#include <tendril/contact/surface_self_contact.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

namespace tendril::scene {
namespace {

using Type = SolidShape::Type;

constexpr double kRangeOfRadius = 0.1;  // the default range over the least radius

Mat3 rotation_of(const Frame& frame) {
  Mat3 m;
  m << frame.x, frame.y, frame.z;
  return m;
}

/// z along a direction; or turned by an angle about an axis.
Frame read_frame(const JsonNode& body) {
  Mat3 m = Mat3::Identity();
  if (body.has("axis")) {
    const Vec3 axis = body.at("axis").vec3();
    if (!(axis.stableNorm() > 0.0)) body.at("axis").refuse("no direction", "a vector that is not zero");
    m = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis.stableNormalized()).toRotationMatrix();
  }
  return {m.col(0), m.col(1), m.col(2)};
}

/// Of uniform density, so that the mass says all; the frame of a body is that of its shape, about whose
/// centre of mass every finite one is symmetric.
Body read_free(const JsonNode& node, const SceneBody& body) {
  Body out;
  out.mass = node.at("mass").positive();
  if (body.shape.type == Type::half_space) node.refuse("a half space", "a body of finite size");
  if (body.shape.type == Type::mesh)
    node.refuse("a mesh", "a fixed or driven one; ball, capsule, box, cylinder, tube");
  out.inertia = (out.mass * moments(body.shape)).asDiagonal();
  out.position = body.pose.position;
  out.rotation = rotation_of(body.pose.frame);
  if (node.has("velocity")) out.velocity = node.at("velocity").vec3();
  if (node.has("spin")) out.spin = node.at("spin").vec3();
  return out;
}

SceneBody read_body(const JsonNode& node, std::size_t index, SceneFile& out) {
  SceneBody body;
  body.pointer = node.pointer();
  body.name = node.text_or("name", "body_" + std::to_string(index));
  for (const SceneBody& other : out.bodies)
    if (other.name == body.name) node.refuse("the name \"" + body.name + "\" is taken", "a name of its own");
  body.shape = read_shape(node.at("shape"));
  if (node.has("position")) body.pose.position = node.at("position").vec3();
  body.pose.frame = read_frame(node);
  body.motion = read_motion(node, body.pose.position, body.pose.frame).pose;
  if (!node.has("free")) return body;
  if (body.motion) node.at("free").refuse("beside a motion", "one of them, not both");
  body.free = out.scene.bodies.size();
  out.scene.bodies.push_back(read_free(node.at("free"), body));
  return body;
}

/// A free body's place is in the state, so that the collider's own is only where it begins.
contact::Collider make_collider(const SceneBody& body) {
  const auto placed = [](const AnchorPose& pose) {
    return contact::Placement{rotation_of(pose.frame), pose.position, pose.velocity, pose.angular_velocity};
  };
  contact::Collider out{body.name, make_shape(body.shape), placed(body.pose)};
  if (body.motion) out.driven = [placed, motion = body.motion](double t) { return placed(motion(t)); };
  out.body = body.free;
  return out;
}

/// Rods are as thick as they are wide, unless the file says otherwise.
std::vector<contact::ContactRod> read_rods(const JsonNode& list, const SceneFile& scene) {
  std::vector<contact::ContactRod> rods;
  for (std::size_t i = 0; i < scene.scene.rods.size(); ++i) {
    const JsonNode one = list.at(i);
    const double radius =
        one.has("contact_radius") ? one.at("contact_radius").positive() : 0.5 * scene.thickness[i];
    if (!(radius > 0.0)) one.refuse("no thickness to come into contact with", "a contact_radius");
    rods.push_back({i, radius, scene.scene.rods[i].p});
  }
  return rods;
}

Falling what_comes(const JsonNode& contact, const SceneFile& scene) {
  const Falling out = falling_of(scene.scene, known_speed(scene), known_fall(scene));
  if (!(out.energy > 0.0))
    contact.refuse("no stiffness, and no gravity or speed to choose one by", "a stiffness");
  return out;
}

/// A stiffness for a range and the least radius of rods.
using Stiffness = std::function<double(double range, double radius)>;

/// What a file may say of a law, beside stiffness and range.
void read_rest(const JsonNode& node, contact::Law& law) {
  if (node.text_or("response", "barrier") == "penalty") law.kind = contact::Law::Kind::penalty;
  law.friction = node.has("friction") ? node.at("friction").not_negative() : 0.0;
  law.damping = node.has("damping") ? node.at("damping").not_negative() : 0.0;
  if (node.has("stick_damping")) law.stick_damping = node.at("stick_damping").not_negative();
  if (node.has("stick_stiffness")) law.stick_stiffness = node.at("stick_stiffness").positive();
}

/// The range is a share of the thinnest rod: shapes seem larger by half of it, so it has to be small beside
/// what is thick, and steps shrink with it, so no smaller than the eye asks for.
contact::Law read_law(const JsonNode& node, const std::vector<contact::ContactRod>& rods,
                      const Stiffness& stiffness) {
  contact::Law law;
  read_rest(node, law);
  double least = std::numeric_limits<double>::infinity();
  for (const contact::ContactRod& rod : rods) least = std::min(least, rod.radius);
  law.range = node.has("range") ? node.at("range").positive() : kRangeOfRadius * least;
  law.stiffness = node.has("stiffness") ? node.at("stiffness").positive() : stiffness(law.range, least);
  return law;
}

double area_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles)
    sum += 0.5 * (points[b] - points[a]).cross(points[c] - points[a]).norm();
  return sum;
}

/// Of the mesh with bodies, and of these with each other. A ball of radius r weighs 2 r among bodies, and
/// pi r range on a surface: their stiffness follows.
void read_mesh_contact(const JsonNode& node, const std::vector<contact::Collider>& colliders,
                       SceneFile& out) {
  const double skin = node.at("skin").positive();
  contact::Law law;
  read_rest(node, law);
  law.range = node.has("range") ? node.at("range").positive() : skin;
  double energy = 0.0;
  law.stiffness = 0.0;
  if (node.has("stiffness")) {
    law.stiffness = node.at("stiffness").positive();
  } else {
    const Falling falling = what_comes(node, out);
    double heaviest = 0.0;
    for (const Body& body : out.scene.bodies) heaviest = std::max(heaviest, body.mass);
    energy = (falling.mass + heaviest) * falling.energy;
  }
  out.mesh_contact.place = node.pointer();
  out.mesh_contact.make = [=](std::shared_ptr<const RodPoints> points, const std::vector<Vec3>& rest,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    contact::Law of_area = law;
    if (law.stiffness == 0.0)
      of_area.stiffness =
          surface_stiffness(energy, colliders, skin, law.range, area_of(rest, triangles), rest.size());
    return std::make_shared<contact::SurfaceContact>(
        contact::ContactSurface{std::move(points), rest, triangles, skin}, colliders, of_area);
  };
  if (out.scene.bodies.empty() || colliders.size() < 2) return;
  if (law.stiffness == 0.0) law.stiffness = balls_stiffness(energy, colliders, skin, law.range);
  law.stiffness *= 0.5 * std::numbers::pi * law.range;
  node.locate([&] { out.scene.forces.push_back(std::make_shared<contact::BodyContact>(colliders, law)); });
  out.force_places.push_back(node.pointer());
}

/// Of the mesh with itself.
void read_mesh_self_contact(const JsonNode& node, SceneFile& out) {
  const double skin = node.at("skin").positive();
  const auto which =
      node.text_or("meets", "all") == "all" ? contact::Meets::all : contact::Meets::other_parts;
  contact::Law law;
  read_rest(node, law);
  law.range = node.has("range") ? node.at("range").positive() : skin;
  double energy = 0.0;
  law.stiffness = node.has("stiffness") ? node.at("stiffness").positive() : 0.0;
  if (law.stiffness == 0.0) {
    const Falling falling = what_comes(node, out);
    energy = falling.heaviest * falling.energy;
  }
  out.mesh_self_contact.place = node.pointer();
  out.mesh_self_contact.make = [=](std::shared_ptr<const RodPoints> points, const std::vector<Vec3>& rest,
                                   const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    contact::Law of_area = law;
    const double triangle =
        area_of(rest, triangles) / static_cast<double>(std::max<std::size_t>(1, triangles.size()));
    if (law.stiffness == 0.0) of_area.stiffness = sheets_stiffness(energy, skin, law.range, triangle);
    return std::make_shared<contact::SurfaceSelfContact>(
        contact::ContactSurface{std::move(points), rest, triangles, skin}, of_area, which);
  };
}

/// Of rods with each other and themselves.
void read_self_contact(const JsonNode& file, SceneFile& out) {
  if (!file.has("self_contact")) return;
  const JsonNode node = file.at("self_contact");
  if (node.text_or("response", "barrier") == "off") return;
  if (node.text_or("of", "rods") == "mesh") return read_mesh_self_contact(node, out);
  for (const char* key : {"skin", "meets"})
    if (node.has(key)) node.at(key).refuse("of rods", "\"of\": \"mesh\" beside it");
  const std::vector<contact::ContactRod> rods = read_rods(file.at("curve_pairs"), out);
  std::vector<contact::RodJoint> joints;
  for (const Joint& joint : out.scene.joints)
    joints.push_back({{joint.parent, joint.child}, {joint.node, 0}});
  const contact::Law law = read_law(node, rods, [&](double range, double radius) {
    return crossing_stiffness(out.scene, what_comes(node, out), range, radius);
  });
  out.self_contact = out.scene.forces.size();
  node.locate(
      [&] { out.scene.forces.push_back(std::make_shared<contact::RodRodContact>(rods, joints, law)); });
  out.force_places.push_back(node.pointer());
}

/// Of rods with bodies, and of these with each other.
void read_body_contact(const JsonNode& file, SceneFile& out) {
  if (!file.has("bodies")) {
    if (file.has("contact")) file.at("contact").refuse("no bodies", "bodies that rods meet");
    return;
  }
  const JsonNode list = file.at("bodies");
  for (std::size_t i = 0; i < list.size(); ++i) out.bodies.push_back(read_body(list.at(i), i, out));
  static const Json kDefault = Json::object();
  const JsonNode contact = file.has("contact") ? file.at("contact") : JsonNode(file.file(), kDefault, "");
  if (contact.text_or("response", "barrier") == "off" || out.bodies.empty()) return;
  std::vector<contact::Collider> colliders;
  for (const SceneBody& body : out.bodies) colliders.push_back(make_collider(body));
  if (contact.text_or("of", "rods") == "mesh") return read_mesh_contact(contact, colliders, out);
  if (contact.has("skin")) contact.at("skin").refuse("of rods", "\"of\": \"mesh\" beside it");
  const std::vector<contact::ContactRod> rods = read_rods(file.at("curve_pairs"), out);
  const JsonNode place = file.has("contact") ? contact : list;
  const contact::Law law = read_law(contact, rods, [&](double range, double radius) {
    return solids_stiffness(out.scene, what_comes(contact, out), colliders, range, radius);
  });
  const auto add = [&](std::shared_ptr<const Force> force) {
    out.scene.forces.push_back(std::move(force));
    out.force_places.push_back(place.pointer());
  };
  out.contact = out.scene.forces.size();
  place.locate([&] { add(std::make_shared<contact::RodContact>(rods, colliders, law)); });
  // Bodies among themselves are a force of their own: a scene without free ones does not pay for it.
  if (out.scene.bodies.empty() || out.bodies.size() < 2) return;
  contact::Law of_bodies = law;
  if (!contact.has("stiffness"))
    of_bodies.stiffness =
        std::max(law.stiffness, bodies_stiffness(out.scene, what_comes(contact, out), colliders, law.range));
  place.locate([&] { add(std::make_shared<contact::BodyContact>(colliders, of_bodies)); });
}

/// What a force of the scene remembers; null where it has no such memory.
template <class Memory>
const Memory* memory_of(const std::optional<std::size_t>& force, const State& state) {
  if (!force || *force >= state.memory.size()) return nullptr;
  return dynamic_cast<const Memory*>(state.memory[*force].get());
}

}  // namespace

void read_contact(const JsonNode& file, SceneFile& out) {
  read_body_contact(file, out);
  read_self_contact(file, out);
}

std::vector<ContactPoint> contacts_of(const SceneFile& file, const State& state) {
  std::vector<ContactPoint> result;
  const auto* memory = memory_of<contact::ContactMemory>(file.contact, state);
  if (memory == nullptr) return result;
  for (const contact::Contact& c : memory->contacts)
    result.push_back(
        {c.rod, c.node, c.fraction, c.solid, c.gap, c.point, c.normal, c.force, c.friction, c.sticks});
  return result;
}

std::vector<MeshContactPoint> mesh_contacts_of(const SceneFile& file, const State& state) {
  std::vector<MeshContactPoint> result;
  const auto* memory = memory_of<contact::SurfaceMemory>(file.mesh_contact.force, state);
  if (memory == nullptr) return result;
  for (const contact::SurfaceTouch& t : memory->touches)
    result.push_back({t.triangle, t.solid, t.gap, t.point, t.normal, t.force, t.friction, t.sticks});
  return result;
}

std::vector<MeshSelfContactPoint> mesh_self_contacts_of(const SceneFile& file, const State& state) {
  std::vector<MeshSelfContactPoint> result;
  const auto* memory = memory_of<contact::SurfaceSelfMemory>(file.mesh_self_contact.force, state);
  if (memory == nullptr) return result;
  for (const contact::SelfTouch& t : memory->touches)
    result.push_back(
        {{t.triangle[0], t.triangle[1]}, t.gap, t.point, t.normal, t.force, t.friction, t.sticks});
  return result;
}

std::vector<RodContactPoint> rod_contacts_of(const SceneFile& file, const State& state) {
  std::vector<RodContactPoint> result;
  const auto* memory = memory_of<contact::RodRodMemory>(file.self_contact, state);
  if (memory == nullptr) return result;
  for (const contact::RodTouch& t : memory->touches)
    result.push_back({t.rod, t.node, t.fraction, t.gap, t.point, t.normal, t.force, t.friction, t.sticks});
  return result;
}

}  // namespace tendril::scene
