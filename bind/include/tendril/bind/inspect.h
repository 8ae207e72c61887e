#pragma once

#include <tendril/base/export.h>
#include <tendril/bind/polygon_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

/// What a mesh is like, before anything is built on it. Nothing is changed and nothing is a fault as such:
/// binding deforms any soup; what the defects break is said where it matters.
namespace tendril::bind {

/// An item that equals an earlier one.
struct Duplicate {
  std::uint32_t id;     ///< of the item
  std::uint32_t first;  ///< of the first one that it equals
  /// Memberwise.
  friend bool operator==(const Duplicate&, const Duplicate&) = default;
};

/// An edge by its two points, the smaller id first.
using Edge = std::array<std::uint32_t, 2>;

/// Ids are positions in PolygonMesh, lists are in ascending order. An edge is a pair of different points that
/// follow each other in a face; a face uses it once each time they do.
struct MeshReport {
  std::size_t points = 0;          ///< of the mesh, isolated ones included
  std::size_t faces = 0;           ///< of the mesh
  std::size_t triangles = 0;       ///< faces of three corners
  std::size_t largest_degree = 0;  ///< most corners of a face
  Vec3 low = Vec3::Zero();         ///< least coordinates of all points
  Vec3 high = Vec3::Zero();        ///< largest coordinates of all points

  std::vector<Duplicate> duplicate_points;      ///< coordinates equal as numbers (0 equals -0)
  std::vector<std::uint32_t> isolated_points;   ///< in no face
  std::vector<std::uint32_t> degenerate_faces;  ///< a point twice, or no area: see inspect
  std::vector<Duplicate> duplicate_faces;       ///< the same points, in whatever order
  std::vector<Edge> non_manifold_edges;         ///< used more than twice
  std::vector<Edge> inconsistent_edges;         ///< used twice in the same direction
  std::vector<std::uint32_t>
      non_manifold_points;  ///< their faces, joined by edges used twice, are several fans

  /// Closed parts (faces joined by edges of two) within no other whose faces look inward.
  std::size_t inside_out = 0;

  std::size_t edges = 0;           ///< different ones
  std::size_t boundary_edges = 0;  ///< used once
  /// Closed curves of boundary edges. Where two holes touch in a point they count apart.
  std::size_t boundary_loops = 0;
  std::size_t components = 0;  ///< of faces joined by points
  /// Points in a face - edges + faces: 2 (components - handles) - loops for an orientable manifold.
  std::int64_t euler_characteristic = 0;

  /// No edge is used once.
  bool is_closed() const { return boundary_edges == 0; }
  /// No edge is used more than twice, and every point has one fan of faces.
  bool is_manifold() const { return non_manifold_edges.empty() && non_manifold_points.empty(); }
  /// Faces that share an edge used twice agree on which side is out.
  bool is_oriented() const { return inconsistent_edges.empty(); }
};

/// Reports on a mesh. A face has no area when |sum of its corners' cross products|, which is twice the area
/// of a planar face, is at most 1e-14 times the square of the longest side of its bounding box: not above
/// what rounding alone can leave.
///
/// Deterministic; time O(n log n), memory O(n) in points and corners. Throws InvalidInput when
/// require_valid(mesh) does.
TENDRIL_BIND_API MeshReport inspect(const PolygonMesh& mesh);

}  // namespace tendril::bind
