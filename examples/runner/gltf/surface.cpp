#include "gltf/surface.h"

#include <cmath>
#include <map>

namespace tendril::runner {
namespace {

/// What tells one vertex of a point from another.
struct Look {
  Vec3f normal;
  bind::Color color;

  bool operator==(const Look& other) const { return normal == other.normal && color == other.color; }
};

float linear(std::uint8_t value) {
  const float v = static_cast<float>(value) / 255.0F;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

std::array<float, 4> linear(const bind::Color& c) {
  return {linear(c[0]), linear(c[1]), linear(c[2]), static_cast<float>(c[3]) / 255.0F};
}

Vec3f unit(const Vec3& v) {
  const double length = v.stableNorm();
  return length > 0.0 ? Vec3f((v / length).cast<float>().normalized()) : Vec3f(0.0F, 0.0F, 1.0F);
}

/// Vertices made as they are met.
class Vertices {
 public:
  Vertices(std::size_t points, Surface& out) : of_(points), out_(out) {}

  std::uint32_t vertex(std::uint32_t point, const Look& look, bool colored) {
    for (const auto& [known, vertex] : of_[point])
      if (known == look) return vertex;
    const auto vertex = static_cast<std::uint32_t>(out_.point.size());
    of_[point].emplace_back(look, vertex);
    out_.point.push_back(point);
    out_.normals.push_back(look.normal);
    if (colored) out_.colors.push_back(linear(look.color));
    return vertex;
  }

 private:
  std::vector<std::vector<std::pair<Look, std::uint32_t>>> of_;
  Surface& out_;
};

Surface cloud(const bind::PolygonMesh& mesh) {
  Surface out;
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
    out.point.push_back(i);
    if (!mesh.point_colors.empty()) out.colors.push_back(linear(mesh.point_colors[i]));
  }
  return out;
}

bind::Color color_at(const bind::PolygonMesh& mesh, std::size_t face, std::uint32_t point) {
  if (!mesh.point_colors.empty()) return mesh.point_colors[point];
  return mesh.face_colors.empty() ? bind::Color{} : mesh.face_colors[face];
}

}  // namespace

Surface make_surface(const bind::PolygonMesh& mesh) {
  if (mesh.face_count() == 0) return cloud(mesh);
  const bool colored = !mesh.point_colors.empty() || !mesh.face_colors.empty();
  const double size = std::max(bind::bounding_diagonal(mesh.points), 1e-300);
  const Shape shape = mesh.point_normals.empty() ? make_shape(mesh, mesh.points.front(), size) : Shape{};
  std::vector<std::size_t> face_of;
  const auto triangles = bind::fan_triangles(mesh, &face_of);
  Surface out;
  Vertices vertices(mesh.points.size(), out);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = triangles[f][k];
      const Vec3 normal =
          mesh.point_normals.empty() ? Vec3(shape.normals[3 * f + k].cast<double>()) : mesh.point_normals[i];
      out.triangles.push_back(vertices.vertex(i, {unit(normal), color_at(mesh, face_of[f], i)}, colored));
    }
  }
  return out;
}

}  // namespace tendril::runner
