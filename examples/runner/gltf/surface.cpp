#include "gltf/surface.h"

#include <cmath>
#include <map>

namespace tendril::runner {
namespace {

/// What tells one vertex of a point from another.
struct Look {
  Vec3f normal;
  bind::Color color;
  std::array<float, 2> texture;

  bool operator==(const Look& other) const {
    return normal == other.normal && color == other.color && texture == other.texture;
  }
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

/// Meshes count a picture's rows from below, the file from above.
std::array<float, 2> from_above(const bind::TextureCoordinate& t) {
  return {static_cast<float>(t[0]), static_cast<float>(1.0 - t[1])};
}

/// Vertices made as they are met.
class Vertices {
 public:
  Vertices(const bind::PolygonMesh& mesh, Surface& out)
      : of_(mesh.points.size()),
        out_(out),
        colored_(!mesh.point_colors.empty() || !mesh.face_colors.empty()),
        textured_(!mesh.point_texture.empty() || !mesh.corner_texture.empty()) {}

  std::uint32_t vertex(std::uint32_t point, const Look& look) {
    for (const auto& [known, vertex] : of_[point])
      if (known == look) return vertex;
    const auto vertex = static_cast<std::uint32_t>(out_.point.size());
    of_[point].emplace_back(look, vertex);
    out_.point.push_back(point);
    out_.normals.push_back(look.normal);
    if (colored_) out_.colors.push_back(linear(look.color));
    if (textured_) out_.texture.push_back(look.texture);
    return vertex;
  }

 private:
  std::vector<std::vector<std::pair<Look, std::uint32_t>>> of_;
  Surface& out_;
  bool colored_, textured_;
};

Surface cloud(const bind::PolygonMesh& mesh) {
  Surface out;
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
    out.point.push_back(i);
    if (!mesh.point_colors.empty()) out.colors.push_back(linear(mesh.point_colors[i]));
    if (!mesh.point_texture.empty()) out.texture.push_back(from_above(mesh.point_texture[i]));
  }
  return out;
}

bind::Color color_at(const bind::PolygonMesh& mesh, std::size_t face, std::uint32_t point) {
  if (!mesh.point_colors.empty()) return mesh.point_colors[point];
  return mesh.face_colors.empty() ? bind::Color{} : mesh.face_colors[face];
}

std::array<float, 2> texture_at(const bind::PolygonMesh& mesh, std::size_t corner) {
  if (!mesh.corner_texture.empty()) return from_above(mesh.corner_texture[corner]);
  return mesh.point_texture.empty() ? std::array<float, 2>{}
                                    : from_above(mesh.point_texture[mesh.corners[corner]]);
}

}  // namespace

Surface make_surface(const bind::PolygonMesh& mesh) {
  if (mesh.face_count() == 0) return cloud(mesh);
  const double size = std::max(bind::bounding_diagonal(mesh.points), 1e-300);
  const Shape shape = mesh.point_normals.empty() ? make_shape(mesh, mesh.points.front(), size) : Shape{};
  Surface out;
  Vertices vertices(mesh, out);
  std::size_t drawn = 0;  // corners of triangles
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::size_t first = mesh.face_begin[f], end = mesh.face_begin[f + 1];
    for (std::size_t last = first + 2; last < end; ++last)
      for (const std::size_t corner : {first, last - 1, last}) {
        const std::uint32_t i = mesh.corners[corner];
        const Vec3 normal =
            mesh.point_normals.empty() ? Vec3(shape.normals[drawn].cast<double>()) : mesh.point_normals[i];
        ++drawn;
        out.triangles.push_back(
            vertices.vertex(i, {unit(normal), color_at(mesh, f, i), texture_at(mesh, corner)}));
      }
  }
  return out;
}

}  // namespace tendril::runner
