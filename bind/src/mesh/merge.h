#pragma once

#include <tendril/bind/inspect.h>

namespace tendril::bind {

/// Of each point, the earliest kept one within `distance` times the diagonal of the bounding box, or itself;
/// with 0, the first one of the same coordinates. Taken in order, so no chain of near points collapses into
/// one: what is kept is farther apart than that. O(n log n).
std::vector<std::uint32_t> merge_targets(const PolygonMesh& mesh, double distance);

/// Edges used once; ascending.
std::vector<Edge> open_edges(const PolygonMesh& mesh);

}  // namespace tendril::bind
