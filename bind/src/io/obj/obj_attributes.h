#pragma once

#include "io/values/import_values.h"

namespace tendril::bind {

/// Normals and texture coordinates of an OBJ file, which stand in lists of their own, and the entry that each
/// corner names.
struct ObjAttributes {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<Vec3> normals;
  std::vector<TextureCoordinate> textures;
  std::vector<std::uint32_t> normal_of_corner, texture_of_corner;  ///< none where no corner names any

  /// Enters what the next corner names, kNone for nothing.
  void add_corner(std::size_t corner, std::uint32_t texture, std::uint32_t normal) {
    enter(texture_of_corner, corner, texture);
    enter(normal_of_corner, corner, normal);
  }

  /// Gives the mesh the normals, where each of its points has one, and the texture coordinates: of points
  /// where each has one pair, else of corners. What is left out or filled in is told.
  void give(PolygonMesh& mesh, const std::string& name, const Notes& notes) const;

 private:
  static void enter(std::vector<std::uint32_t>& list, std::size_t corner, std::uint32_t id) {
    if (id == kNone && list.empty()) return;  // most files lack one of the two
    list.resize(corner, kNone);
    list.push_back(id);
  }
};

}  // namespace tendril::bind
