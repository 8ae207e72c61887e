#pragma once

#include <boost/property_map/property_map.hpp>

namespace tendril::bind {

/// Vertex point map of an OpenMesh mesh that keeps the mesh's own number type. CGAL 5.5's map for OpenMesh
/// rounds every coordinate to float when it writes, also into a mesh of doubles: hand this one to
/// face_graph.h instead.
template <class Mesh>
class OpenMeshPointMap {
 public:
  using key_type = typename Mesh::VertexHandle;         ///< of Boost's concept
  using value_type = typename Mesh::Point;              ///< of Boost's concept
  using reference = value_type;                         ///< of Boost's concept
  using category = boost::read_write_property_map_tag;  ///< of Boost's concept

  /// \param mesh  kept by reference
  explicit OpenMeshPointMap(Mesh& mesh) : mesh_(&mesh) {}

  /// Position of a vertex.
  friend reference get(const OpenMeshPointMap& map, key_type vertex) { return map.mesh_->point(vertex); }
  /// Sets it.
  friend void put(const OpenMeshPointMap& map, key_type vertex, const value_type& point) {
    map.mesh_->set_point(vertex, point);
  }

 private:
  Mesh* mesh_;
};

}  // namespace tendril::bind
