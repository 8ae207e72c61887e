#pragma once

#include <tendril/base/types.h>

#include <array>
#include <cstddef>

namespace tendril {

/// Up to 128 edges in the air, number by number: the vectors along them, the means of their ends' velocities,
/// their widths, and the air's velocity at their middles over that of the mean wind.
struct ExposedEdges {
  static constexpr std::size_t kMost = 128;
  using Numbers = std::array<double, kMost>;
  Numbers x, y, z, vx, vy, vz, width, air;
};

/// What the air does to them: coefficients of flow across and along an edge, over length and width, with the
/// factor -rho / 4 of one end.
struct DragPerLength {
  Vec3 mean;  ///< wind
  double normal, tangential;
};

/// The drag of half of each edge, into x, y and z: with e the unit vector, l the length and w the flow past
/// the edge, l width (c_n |w_n| w_n + c_t |w_t| w_t). Edges have a length.
void drag(const DragPerLength& by, std::size_t count, ExposedEdges& edges);

}  // namespace tendril
