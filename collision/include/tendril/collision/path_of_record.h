#pragma once

#include <tendril/base/types.h>

#include <array>

namespace tendril::collision {

/// A vertex at an accepted step.
struct Passing {
  Vec3 position;  ///< where it is
  Vec3 velocity;  ///< how fast it moves, in the units of the position and the step's duration
};

/// Time-control points of the path of record: the path on which a vertex is declared to move between two
/// accepted steps, and for which the continuous tests are exact. It is the cubic Hermite path through the
/// positions with the velocities at the steps, on [0, 1]: p_0, p_0 + h v_0 / 3, p_1 - h v_1 / 3, p_1. Its
/// ends are the positions to the last bit, so that one step's path meets the next one's; all of it lies in
/// the box of the four points. From the true motion it is off by at most h^4 max |p''''| / 384.
/// \param from  the vertex at the first step
/// \param to    the vertex at the second
/// \param h     the duration between them
inline std::array<Vec3, 4> path_of_record(const Passing& from, const Passing& to, double h) {
  return {from.position, from.position + h / 3.0 * from.velocity, to.position - h / 3.0 * to.velocity,
          to.position};
}

}  // namespace tendril::collision
