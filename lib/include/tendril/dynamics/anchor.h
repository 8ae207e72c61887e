#pragma once

#include <tendril/curve/frames.h>

#include <functional>
#include <limits>
#include <vector>

namespace tendril {

/// Where an anchor holds its node, and how it moves there.
struct AnchorPose {
  Vec3 position = Vec3::Zero();          ///< [length]
  Frame frame;                           ///< (l, m, t) the node takes
  Vec3 velocity = Vec3::Zero();          ///< d position / dt
  Vec3 angular_velocity = Vec3::Zero();  ///< of the frame
};

/// A node whose position, frame or both are given instead of integrated: a clamp (both), a hinge (position),
/// a guide (frame). The rod feels it by the springs between the anchor's frame and the adjacent edges and by
/// the twist springs to the neighbours; clamping the frame, instead of fixing two nodes, keeps second order.
struct Anchor {
  std::size_t rod = 0;         ///< index in Scene::rods
  std::size_t node = 0;        ///< of the rod
  bool holds_position = true;  ///< the node is where the pose says
  bool holds_frame = true;     ///< the node's frame is the pose's
  /// Pose as a pure function of time, its velocities the exact derivatives. Empty: fixed where the node is at
  /// rest.
  std::function<AnchorPose(double)> motion = {};
  /// Releases its node at this time: a simulation goes on with the node free from there, its step control
  /// restarted. A released frame at once becomes that of a free node, for it has no inertia across its
  /// tangent: the energy by which it had bent its springs is lost. Statics never releases.
  double until = std::numeric_limits<double>::infinity();
  /// The shortest period of the motion, as Force::period(); infinite where it has none.
  double period = std::numeric_limits<double>::infinity();
  std::vector<double> breaks = {};  ///< times at which the motion's velocity jumps: steps end there
  /// What a held position may do: nothing, or slide without friction along a line through the pose's place,
  /// or in a plane through it. Both keep their direction in the world however the pose turns; along what is
  /// free the pose's place and velocity count for nothing.
  enum class Slide {
    none,  ///< held whole
    line,  ///< slides along slide_axis
    plane  ///< slides across it
  };
  Slide slide = Slide::none;        ///< of a held position alone, else InvalidInput
  Vec3 slide_axis = Vec3::UnitZ();  ///< direction of the line, normal of the plane: finite, not 0
  /// A held frame turns freely about one axis, as a door on its hinges, with the node's spin inertia; about
  /// others it is as the pose says. About the tangent that is a shaft in a bearing.
  bool swivels = false;              ///< of a held frame alone, else InvalidInput
  Vec3 swivel_axis = Vec3::UnitZ();  ///< at rest; it turns with the pose's frame: finite, not 0
};

}  // namespace tendril
