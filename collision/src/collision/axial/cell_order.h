#pragma once

#include <tendril/collision/placed_cells.h>

/// The order of triangles in a hierarchy over axial space, and the points of its cells.
namespace tendril::collision {

/// Indices of the triangles so that every node of PlacedCells holds neighbours: split at the median of the
/// middles along the widest of pair, t (in lengths), u, v and w. Those of the first place count.
std::vector<std::uint32_t> axial_order(std::span<const CurvePair> rest, const BoundPoints& points,
                                       std::span<const Triangle> triangles);

/// The points of all cells, each cell's in the order of their first use, and the corners among them.
struct CellPoints {
  std::vector<std::uint32_t> begin{0}, points;
  std::vector<std::array<std::uint8_t, 3>> corner;
};
CellPoints cell_points(std::span<const std::uint32_t> order, std::span<const Triangle> triangles,
                       std::size_t points);

}  // namespace tendril::collision
