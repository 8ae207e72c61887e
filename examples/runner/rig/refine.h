#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::runner {

/// The mesh in triangles, each split in four until its edges are at most `longest`, or until there are
/// 400 000 of them. Points at the middles of edges come after those of the mesh. Neighbours may be split
/// unequally.
bind::PolygonMesh split_long_edges(const bind::PolygonMesh& mesh, double longest);

/// The faces joined by points, or by points at the same place, that have the largest area together, and
/// their points; without attributes.
bind::PolygonMesh largest_part(const bind::PolygonMesh& mesh);

}  // namespace tendril::runner
