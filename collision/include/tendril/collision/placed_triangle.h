#pragma once

#include <tendril/collision/box_tree.h>

#include <array>

namespace tendril::collision {

/// A triangle as a query sees it.
struct PlacedTriangle {
  std::uint32_t index;          ///< among the triangles given
  std::array<Vec3, 3> corners;  ///< the very doubles of the updated mesh
  Box box;                      ///< of the corners, exact
};

}  // namespace tendril::collision
