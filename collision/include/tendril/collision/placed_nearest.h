#pragma once

#include <tendril/collision/placed_cells.h>

namespace tendril::collision {

/// Calls visit(triangle) for triangles in the order in which their boxes come near: the child with the
/// smaller distance(box) first, and only while that is not more than bound(), which may shrink as triangles
/// are visited. Cells that are farther are not deformed.
/// \param cells     posed
/// \param n         the node to begin at
/// \param distance  of a box from what is asked about, never above that of anything in the box
/// \param bound     how far is near enough
/// \param visit     gets a PlacedTriangle
template <class Distance, class Bound, class Visit>
void nearest(PlacedCells& cells, const PlacedCells::Node& n, Distance& distance, Bound& bound, Visit& visit) {
  if (!(distance(cells.box(n)) <= bound())) return;
  if (cells.open(n) && !(distance(cells.box(n)) <= bound())) return;
  if (n.leaf()) {
    cells.triangles(n, [&](const PlacedTriangle& triangle) {
      if (distance(triangle.box) <= bound()) visit(triangle);
    });
    return;
  }
  const bool swap = distance(cells.box(n.right())) < distance(cells.box(n.left()));
  nearest(cells, swap ? n.right() : n.left(), distance, bound, visit);
  nearest(cells, swap ? n.left() : n.right(), distance, bound, visit);
}

}  // namespace tendril::collision
