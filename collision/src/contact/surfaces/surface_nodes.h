#pragma once

#include <tendril/dynamics/force.h>
#include <tendril/dynamics/rod_points.h>

#include <vector>

namespace tendril::contact {

/// Adds those of a rod, flat indices.
inline void add_nodes(const NodeRange& rod, std::vector<std::size_t>& to) {
  for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) to.push_back(i);
}
/// Flat indices of the nodes of a surface's rods.
std::vector<std::size_t> nodes_of(const RodPoints& points, std::span<const NodeRange> rods);
/// Throws InvalidInput where the scene's rods are not those that the surface is bound to.
void check_nodes(const RodPoints& points, std::span<const NodeRange> rods);

}  // namespace tendril::contact
