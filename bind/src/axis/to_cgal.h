#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <tendril/bind/polygon_mesh.h>

namespace tendril::axis {

using CgalMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

/// \param mesh  manifold triangles
inline CgalMesh to_cgal(const bind::PolygonMesh& mesh) {
  CgalMesh out;
  std::vector<CgalMesh::Vertex_index> vertex;
  for (const Vec3& p : mesh.points) vertex.push_back(out.add_vertex({p.x(), p.y(), p.z()}));
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    out.add_face(vertex[face[0]], vertex[face[1]], vertex[face[2]]);
  }
  return out;
}

}  // namespace tendril::axis
