#pragma once

#include "io/values/cursor.h"
#include "io/values/import_values.h"

/// What the two kinds of OFF share.
namespace tendril::bind {

struct OffHeader {
  bool normals = false, colors = false, texture = false, binary = false;
  std::size_t vertices = 0, faces = 0;
};

inline void reserve(PolygonMesh& mesh, const OffHeader& header, std::size_t bytes, std::size_t least_vertex,
                    std::size_t least_face, std::size_t least_corner) {
  reserve_within(mesh.points, header.vertices, bytes, least_vertex);
  if (header.normals) reserve_within(mesh.point_normals, header.vertices, bytes, 2 * least_vertex);
  if (header.texture) reserve_within(mesh.point_texture, header.vertices, bytes, 2 * least_vertex);
  reserve_within(mesh.face_begin, header.faces + 1, bytes, least_face);
  reserve_within(mesh.corners, 3 * header.faces, bytes, least_corner);
}

/// Vertices and faces of a binary OFF, from the counts on: big-endian, a count of color values behind each
/// face. Tolerant, it tries also little-endian numbers and faces without that count, as some exporters write,
/// and takes the first of the four that fits the bytes to the last one.
/// \param begin  of the counts
PolygonMesh read_off_binary(std::string_view bytes, std::size_t begin, const std::string& name,
                            const OffHeader& header, const Notes& notes);

}  // namespace tendril::bind
