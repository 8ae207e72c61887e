#pragma once

#include <tendril/curve/frames.h>

#include <functional>
#include <limits>

namespace tendril {

/// Where an anchor holds its node, and how it moves there.
struct AnchorPose {
  Vec3 position = Vec3::Zero();
  Frame frame;                           ///< (l, m, t) the node takes
  Vec3 velocity = Vec3::Zero();          ///< d position / dt
  Vec3 angular_velocity = Vec3::Zero();  ///< of the frame
};

/// A node whose position, frame or both are given instead of integrated: a clamp (both), a hinge (position),
/// a guide (frame). The springs between the anchor's frame and the adjacent edges, and the twist springs to
/// the neighbours, do the rest; clamping the frame instead of fixing two nodes keeps second order.
struct Anchor {
  std::size_t rod = 0;
  std::size_t node = 0;
  bool holds_position = true;
  bool holds_frame = true;
  /// Pose as a pure function of time, its velocities the exact derivatives. Empty: fixed where the node is at
  /// rest.
  std::function<AnchorPose(double)> motion = {};
  /// Lets go at this time: a simulation goes on with the node free from there, its controller begun anew.
  /// What a held frame had bent its springs by is gone with it, for a node's frame has no mass across its
  /// tangent. Statics holds on.
  double until = std::numeric_limits<double>::infinity();
};

}  // namespace tendril
