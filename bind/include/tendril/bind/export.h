#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/polygon_mesh.h>

#include <string>

/// Surface meshes to PLY and OFF. What is written and read again by import.h is the same mesh, bit for bit
/// (signed zeros and subnormals too), with its normals, colors and texture coordinates.
///
/// All throw InvalidInput, and write nothing, when require_valid(mesh) does.
namespace tendril::bind {

/// How a PLY file is written.
struct PlyOptions {
  /// Coordinates and normals in single precision: half the size, for frames that are only displayed. Values
  /// beyond its range are refused.
  bool float32 = false;
};

/// Whether single precision places points within 1e-5 of the diagonal of their bounding box: not where they
/// lie far from the origin for their size, as map coordinates do. True for no points.
TENDRIL_BIND_API bool single_precision_serves(Points points);

/// Binary little-endian PLY: x y z [nx ny nz] [red green blue alpha] [s t] and lists vertex_indices
/// [texcoord] [red green blue alpha].
TENDRIL_BIND_API std::string ply_bytes(const PolygonMesh& mesh, const PlyOptions& options = {});

/// Text OFF, [ST][C][N]OFF when there are texture coordinates of points, colors or normals; each number in
/// its shortest form that reads back unchanged. It has no place for texture coordinates of corners: they are
/// left out.
TENDRIL_BIND_API std::string off_text(const PolygonMesh& mesh);

/// Writes ply_bytes(mesh) or off_text(mesh), as the ending .ply or .off says; another ending throws
/// InvalidInput. The file is written whole or not at all (FileError).
TENDRIL_BIND_API void write_mesh(const std::string& path, const PolygonMesh& mesh);

}  // namespace tendril::bind
