#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <string>

/// Meshes as files of the formats that are read and not written.
namespace tendril::test {

/// The points and faces as lines of OBJ.
inline std::string obj_text(const bind::PolygonMesh& mesh) {
  std::string out;
  const auto number = [&](double value) {
    std::array<char, 32> text{};
    out += ' ';
    out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
  };
  for (const Vec3& p : mesh.points) {
    out += 'v';
    for (const double c : p) number(c);
    out += '\n';
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    out += 'f';
    for (const std::uint32_t corner : mesh.face(f)) out += ' ' + std::to_string(corner + 1);
    out += '\n';
  }
  return out;
}

/// Triangles as binary STL, with normals of length 0.
inline std::string stl_bytes(const bind::PolygonMesh& mesh, std::string header = "made here") {
  header.resize(80);
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) header += static_cast<char>(value >> 8 * k & 255);
  };
  put(static_cast<std::uint32_t>(mesh.face_count()), 4);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) put(0, 4);
    for (const std::uint32_t corner : mesh.face(f))
      for (const double c : mesh.points[corner]) put(std::bit_cast<std::uint32_t>(static_cast<float>(c)), 4);
    put(0, 2);
  }
  return header;
}

/// Triangles as text STL, each line ended by `end`.
inline std::string stl_text(const bind::PolygonMesh& mesh, const std::string& end = "\n") {
  std::string out = "solid of a name" + end;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    out += "  facet normal 0 0 0" + end + "    outer loop" + end;
    for (const std::uint32_t corner : mesh.face(f)) {
      std::array<char, 96> line{};
      const Vec3& p = mesh.points[corner];
      std::snprintf(line.data(), line.size(), "      vertex %.17g %.17g %.17g", p.x(), p.y(), p.z());
      out += line.data() + end;
    }
    out += "    endloop" + end + "  endfacet" + end;
  }
  return out + "endsolid of a name" + end;
}

}  // namespace tendril::test
