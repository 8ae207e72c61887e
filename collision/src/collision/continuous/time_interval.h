#pragma once

#include <tendril/base/types.h>

#include <array>

namespace tendril::collision {

/// Three vectors, those to the other three vertices from the first: x y z of each.
using Nine = std::array<double, 9>;

inline Eigen::Map<const Vec3> vector(const Nine& nine, int which) {
  return Eigen::Map<const Vec3>(nine.data() + 3 * which);
}

/// The relative positions at a time, and on which side of the plane of the others the first vertex is: the
/// proven sign of their determinant, 0 where rounding hides it.
struct Instant {
  double time;
  Nine place;
  int side;
  std::array<Nine, 2> row;  ///< of a cubic: the one before the place in de Casteljau's scheme
};

/// The relative paths on a part of the time: control[i] are the time-control points there, the first and last
/// of them the places at its ends. Refers to these.
template <int Degree>
struct TimeInterval {
  const Instant &from, &to;
  std::array<Nine, Degree + 1> control;
};

}  // namespace tendril::collision
