#include "scene/solid/solid_reader.h"

#include <tendril/bind/import.h>

#include <algorithm>
#include <map>

namespace tendril::scene {
namespace {

using Type = SolidShape::Type;

const std::map<std::string, std::pair<Type, std::vector<std::string>>>& shape_types() {
  static const std::map<std::string, std::pair<Type, std::vector<std::string>>> types{
      {"half_space", {Type::half_space, {}}},
      {"ball", {Type::ball, {"radius"}}},
      {"capsule", {Type::capsule, {"radius", "length"}}},
      {"box", {Type::box, {"size"}}},
      {"cylinder", {Type::cylinder, {"radius", "length"}}},
      {"tube", {Type::tube, {"inner", "radius", "length"}}},
      {"mesh", {Type::mesh, {"file"}}}};
  return types;
}

}  // namespace

contact::ShapePtr make_shape(const SolidShape& shape) {
  switch (shape.type) {
    case Type::half_space:
      return contact::half_space();
    case Type::ball:
      return contact::ball(shape.radius);
    case Type::capsule:
      return contact::capsule(shape.half, shape.radius);
    case Type::box:
      return contact::box(shape.size);
    case Type::cylinder:
      return contact::cylinder(shape.radius, shape.half);
    case Type::tube:
      return contact::tube(shape.inner, shape.radius, shape.half);
    case Type::mesh:
      return contact::mesh(shape.mesh->points, bind::fan_triangles(*shape.mesh));
  }
  return nullptr;
}

/// The schema knows the keys of all types together; which of them belong to this one is asked here, and the
/// library refuses sizes that are none.
SolidShape read_shape(const JsonNode& node) {
  const auto& [type, keys] = shape_types().at(node.at("type").text());
  for (const auto& item : node.value().items())
    if (item.key() != "type" && std::find(keys.begin(), keys.end(), item.key()) == keys.end())
      node.at(item.key()).refuse("not a key of this shape", "what belongs to its type");
  SolidShape shape;
  shape.type = type;
  for (const std::string& key : keys) node.at(key);
  if (node.has("radius")) shape.radius = node.at("radius").positive();
  if (node.has("inner")) shape.inner = node.at("inner").positive();
  if (node.has("length")) shape.half = 0.5 * node.at("length").positive();
  if (node.has("size")) shape.size = 0.5 * node.at("size").vec3();
  if (node.has("file")) {
    const std::string path = node.at("file").path();
    node.at("file").locate(
        [&] { shape.mesh = std::make_shared<const bind::PolygonMesh>(bind::read_mesh(path)); });
  }
  node.locate([&] { return make_shape(shape); });
  return shape;
}

/// Principal moments of a body of uniform density and mass 1.
Vec3 moments(const SolidShape& shape) {
  const double r2 = shape.radius * shape.radius, h2 = shape.half * shape.half;
  const auto round = [](double about_axis, double across) { return Vec3(across, across, about_axis); };
  switch (shape.type) {
    case Type::box: {
      const Vec3 s = shape.size.cwiseProduct(shape.size) / 3.0;
      return {s.y() + s.z(), s.z() + s.x(), s.x() + s.y()};
    }
    case Type::cylinder:
      return round(r2 / 2, r2 / 4 + h2 / 3);
    case Type::tube: {
      const double both = r2 + shape.inner * shape.inner;
      return round(both / 2, both / 4 + h2 / 3);
    }
    case Type::capsule: {
      // A cylinder and two half balls, by their volumes.
      const double body = 2.0 * shape.half, ends = 4.0 / 3.0 * shape.radius;
      const double c = body / (body + ends), e = 1.0 - c;
      const double offset = shape.half * shape.half + 0.75 * shape.half * shape.radius;
      return round(c * r2 / 2 + e * 0.4 * r2, c * (r2 / 4 + h2 / 3) + e * (0.4 * r2 + offset));
    }
    case Type::ball:
    case Type::half_space:
    case Type::mesh:
      break;
  }
  return Vec3::Constant(0.4 * r2);
}

}  // namespace tendril::scene
