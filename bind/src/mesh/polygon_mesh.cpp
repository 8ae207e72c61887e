#include <tendril/base/error.h>
#include <tendril/bind/polygon_mesh.h>

#include <cmath>
#include <string>

namespace tendril::bind {
namespace {

[[noreturn]] void fail(const char* array, std::size_t i, const std::string& reason,
                       const std::string& expected) {
  throw InvalidInput("PolygonMesh: " + std::string(array) + "[" + std::to_string(i) + "]", reason, expected);
}

void require_finite(const std::vector<Vec3>& vectors, const char* array) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (!is_finite(vectors[i])) fail(array, i, "a value that is not finite", "finite numbers");
  }
}

void require_finite(const std::vector<TextureCoordinate>& list, const char* array) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (!std::isfinite(list[i][0]) || !std::isfinite(list[i][1]))
      fail(array, i, "a value that is not finite", "finite numbers");
}

void require_size(std::size_t size, std::size_t items, const char* array) {
  if (size == 0 || size == items) return;
  throw InvalidInput("PolygonMesh: " + std::string(array), std::to_string(size) + " entries",
                     "none or " + std::to_string(items));
}

void require_faces(const PolygonMesh& mesh) {
  const auto& begin = mesh.face_begin;
  if (begin.empty() || begin.front() != 0) fail("face_begin", 0, "not 0 or missing", "0");
  for (std::size_t f = 0; f + 1 < begin.size(); ++f) {
    if (begin[f + 1] < begin[f] || begin[f + 1] - begin[f] < 3) {
      fail("face_begin", f + 1, std::to_string(begin[f + 1]) + " after " + std::to_string(begin[f]),
           "at least 3 corners per face");
    }
  }
  if (begin.back() != mesh.corners.size()) {
    fail("face_begin", begin.size() - 1, std::to_string(begin.back()),
         std::to_string(mesh.corners.size()) + ", the number of corners");
  }
}

}  // namespace

void require_valid(const PolygonMesh& mesh) {
  require_finite(mesh.points, "points");
  require_finite(mesh.point_normals, "point_normals");
  require_size(mesh.point_normals.size(), mesh.points.size(), "point_normals");
  require_size(mesh.point_colors.size(), mesh.points.size(), "point_colors");
  require_finite(mesh.point_texture, "point_texture");
  require_finite(mesh.corner_texture, "corner_texture");
  require_size(mesh.point_texture.size(), mesh.points.size(), "point_texture");
  require_faces(mesh);
  require_size(mesh.corner_texture.size(), mesh.corners.size(), "corner_texture");
  require_size(mesh.face_colors.size(), mesh.face_count(), "face_colors");
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    if (mesh.corners[c] < mesh.points.size()) continue;
    fail("corners", c, "index " + std::to_string(mesh.corners[c]),
         "an index below " + std::to_string(mesh.points.size()));
  }
}

std::vector<std::array<std::uint32_t, 3>> fan_triangles(const PolygonMesh& mesh,
                                                        std::vector<std::size_t>* face_of) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 2; i < face.size(); ++i) {
      triangles.push_back({face[0], face[i - 1], face[i]});
      if (face_of != nullptr) face_of->push_back(f);
    }
  }
  return triangles;
}

double bounding_diagonal(Points points) {
  if (points.empty()) return 0.0;
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace tendril::bind
