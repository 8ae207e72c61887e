#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::bind {

/// Two points, the smaller id first.
using PointPair = std::array<std::uint32_t, 2>;

/// A mesh of triangles with its edges, each once, ascending.
struct TriangleMesh {
  PolygonMesh mesh;
  std::vector<std::uint32_t> face_of;  ///< of the body, that each triangle is a part of
  std::vector<PointPair> edges;

  /// The body's faces as fans.
  explicit TriangleMesh(const PolygonMesh& body);
  /// Every triangle split in four at the middles of its edges, which become points in the order of the edges.
  TriangleMesh split() const;

  /// For each edge a face of the body that it is on.
  std::vector<std::uint32_t> faces_of_edges() const;

 private:
  TriangleMesh() = default;
  void find_edges();
  std::size_t edge_of(std::uint32_t a, std::uint32_t b) const;  ///< a != b
};

}  // namespace tendril::bind
