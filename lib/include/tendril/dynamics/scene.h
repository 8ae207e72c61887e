#pragma once

#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/body.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/joint.h>
#include <tendril/dynamics/rod.h>

#include <memory>
#include <vector>

namespace tendril {

/// What a scene is made of. Plain data; System checks it.
struct Scene {
  std::vector<Rod> rods;                             ///< at least one, or a body
  std::vector<Anchor> anchors;                       ///< at most one a node
  std::vector<Joint> joints;                         ///< make trees of the rods
  std::vector<std::shared_ptr<const Force>> forces;  ///< none null

  /// Which rods have the twist angle and spin of each node in their state. The others keep the directors that
  /// parallel transport carries along them, and bend by the angle between edges alone.
  enum class Twist {
    /// Rods with unequal bending stiffnesses, a curved rest shape, viscosity, a joint, a moving held frame or
    /// several held frames; all when a force twists.
    where_needed,
    everywhere  ///< all rods
  };
  Twist twist = Twist::where_needed;  ///< how it is decided
  std::vector<Body> bodies = {};      ///< free rigid bodies
};

}  // namespace tendril
