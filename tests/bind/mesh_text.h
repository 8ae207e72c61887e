#pragma once

#include <gtest/gtest.h>
#include <tendril/bind/polygon_mesh.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/mesh_files.h"

/// Meshes and bytes for the tests of import and export.
namespace tendril::bind {

/// Bytes of values in either order, for binary files.
class Bytes {
 public:
  explicit Bytes(std::string text, bool big_endian) : text_(std::move(text)), big_endian_(big_endian) {}

  template <class T, class... Rest>
  Bytes& put(T value, Rest... rest) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    text_.append(raw.data(), raw.size());
    if constexpr (sizeof...(rest) > 0) put(rest...);
    return *this;
  }
  Bytes& text(const std::string& more) {
    text_ += more;
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  std::string text_;
  bool big_endian_;
};

inline PolygonMesh mesh_of(std::vector<Vec3> points, const std::vector<std::vector<std::uint32_t>>& faces) {
  PolygonMesh mesh;
  mesh.points = std::move(points);
  for (const auto& face : faces) {
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
  return mesh;
}

inline PolygonMesh tetrahedron() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
}

/// A square and a triangle on it; five points.
inline PolygonMesh house() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 1.5, -0.25}}, {{0, 1, 2, 3}, {3, 2, 4}});
}

inline std::vector<std::uint64_t> bits(const std::vector<Vec3>& vectors) {
  std::vector<std::uint64_t> list;
  for (const Vec3& v : vectors) {
    for (const double c : v) list.push_back(std::bit_cast<std::uint64_t>(c));
  }
  return list;
}

inline std::vector<std::uint64_t> bits(const std::vector<TextureCoordinate>& list) {
  std::vector<std::uint64_t> out;
  for (const TextureCoordinate& at : list)
    for (const double c : at) out.push_back(std::bit_cast<std::uint64_t>(c));
  return out;
}

/// Every array equal, numbers bit for bit.
inline void expect_same(const PolygonMesh& mesh, const PolygonMesh& expected) {
  EXPECT_EQ(bits(mesh.points), bits(expected.points));
  EXPECT_EQ(mesh.face_begin, expected.face_begin);
  EXPECT_EQ(mesh.corners, expected.corners);
  EXPECT_EQ(bits(mesh.point_normals), bits(expected.point_normals));
  EXPECT_EQ(mesh.point_colors, expected.point_colors);
  EXPECT_EQ(mesh.face_colors, expected.face_colors);
  EXPECT_EQ(bits(mesh.point_texture), bits(expected.point_texture));
  EXPECT_EQ(bits(mesh.corner_texture), bits(expected.corner_texture));
}

using test::obj_text;
using test::stl_bytes;
using test::stl_text;

}  // namespace tendril::bind
