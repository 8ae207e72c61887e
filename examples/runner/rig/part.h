#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::runner {

/// The faces joined by points, or by points at the same place, that have the largest area together, and
/// their points; without attributes.
bind::PolygonMesh largest_part(const bind::PolygonMesh& mesh);

}  // namespace tendril::runner
