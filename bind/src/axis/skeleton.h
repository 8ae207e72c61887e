#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <array>

/// The only use of CGAL's mean-curvature-flow skeletons [Tagliasacchi et al. 2012].
namespace tendril::axis {

/// A graph of points within a surface. Nodes are sorted by their coordinates, edges by their nodes.
struct Skeleton {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 2>> edges;
};

enum class Contraction { converged, out_of_time, not_finite };

struct Contracted {
  Contraction state;
  int steps;
  Skeleton skeleton;  ///< empty unless converged
};

/// \param mesh     closed, connected, manifold triangles that are not degenerate: CGAL may crash on others
/// \param seconds  after which the contraction is given up; making too fine a mesh even, some 10 us a
///                 triangle, comes before and is not watched
Contracted contract(const bind::PolygonMesh& mesh, double seconds);

}  // namespace tendril::axis
