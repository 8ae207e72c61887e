#include "surface_nodes.h"

#include <tendril/base/error.h>

#include <string>

namespace tendril::contact {

std::vector<std::size_t> nodes_of(const RodPoints& points, std::span<const NodeRange> rods) {
  std::vector<std::size_t> all;
  for (const std::size_t rod : points.rods()) add_nodes(rods[rod], all);
  return all;
}

void check_nodes(const RodPoints& points, std::span<const NodeRange> rods) {
  if (points.curves().size() != rods.size())
    throw InvalidInput("contact.surface.points", std::to_string(points.curves().size()) + " rods",
                       "those of the scene, " + std::to_string(rods.size()));
  for (const std::size_t rod : points.rods())
    if (points.curves().parameters(rod).size() != rods[rod].count)
      throw InvalidInput("contact.surface.points", "rod " + std::to_string(rod) + " has other masses",
                         "those of the scene");
}

}  // namespace tendril::contact
