#pragma once

#include <tendril/base/types.h>

#include <cstdint>

namespace tendril::contact {

/// A point's contact with a solid at the last accepted state.
struct KeptTouch {
  std::uint64_t key;  ///< point times the number of colliders, plus the collider
  Vec3 stick_at;      ///< where it sticks, in the frame of the solid
  Vec3 x, friction;   ///< where it was in the world, and the friction on it
};

}  // namespace tendril::contact
