#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tendril::bind {

/// 8-bit red, green, blue, alpha.
using Color = std::array<std::uint8_t, 4>;

/// Where a point of a surface lies in a picture: s, t.
using TextureCoordinate = std::array<double, 2>;

/// A polygon soup on flat arrays, with the attributes that mesh files carry. It makes no promise on
/// manifoldness or orientation: inspect() in inspect.h reports those.
///
/// Face f has the corners `corners[face_begin[f] .. face_begin[f + 1])`, indices into `points`. `face_begin`
/// has one entry more than there are faces, and starts with 0; a mesh without faces has `face_begin == {0}`.
struct PolygonMesh {
  std::vector<Vec3> points;                  ///< positions
  std::vector<std::uint32_t> face_begin{0};  ///< ascending indices into corners
  std::vector<std::uint32_t> corners;        ///< of all faces, in order

  std::vector<Vec3> point_normals;  ///< none, or one per point; of any length
  std::vector<Color> point_colors;  ///< none, or one per point
  std::vector<Color> face_colors;   ///< none, or one per face

  std::vector<TextureCoordinate> point_texture;   ///< none, or one per point
  std::vector<TextureCoordinate> corner_texture;  ///< none, or one per corner: a point may have several

  std::size_t face_count() const { return face_begin.size() - 1; }  ///< number of faces
  /// Corners of face f < face_count(), valid as long as the mesh.
  std::span<const std::uint32_t> face(std::size_t f) const {
    return std::span(corners).subspan(face_begin[f], face_begin[f + 1] - face_begin[f]);
  }
};

/// Throws InvalidInput("PolygonMesh: array[i]", ...) unless the arrays fit together: face_begin starts with
/// 0, grows by at least 3 per face and ends with the number of corners; corners name points that exist;
/// points, normals and texture coordinates are finite; each attribute is empty or has one entry per point,
/// face or corner. O(points + corners).
TENDRIL_BIND_API void require_valid(const PolygonMesh& mesh);

/// Every face as a fan of triangles about its first corner, face after face.
/// \param mesh     valid
/// \param face_of  gets the face of each triangle, unless null
TENDRIL_BIND_API std::vector<std::array<std::uint32_t, 3>> fan_triangles(
    const PolygonMesh& mesh, std::vector<std::size_t>* face_of = nullptr);

/// Diagonal of the axis-aligned bounding box of the points; 0 for none. The size that tolerances are relative
/// to.
TENDRIL_BIND_API double bounding_diagonal(Points points);

}  // namespace tendril::bind
