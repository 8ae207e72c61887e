#pragma once

#include <span>

#include "collision/triangle_pairs.h"

/// Whether two triangles meet, by others, for many pairs at once: 1 or 0 each. Built where they are
/// installed.
namespace tendril::bench {

void cgal_meet(std::span<const test::TrianglePair> pairs, std::span<char> out);
void fcl_meet(std::span<const test::TrianglePair> pairs, std::span<char> out);

}  // namespace tendril::bench
