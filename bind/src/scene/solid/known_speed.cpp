#include "scene/solid/known_speed.h"

#include <algorithm>

namespace tendril::scene {
namespace {

constexpr int kTimes = 1000;

/// Of a rod that begins to move as a rigid body. About its centre of mass it moves no point by more than
/// about any of its own.
double speed_of(const StartMotion& motion, const Rod& rod) {
  double fastest = 0.0;
  for (const Vec3& p : rod.p) {
    const Vec3 arm = p - motion.about.value_or(rod.p.front());
    fastest = std::max(fastest, (motion.velocity + motion.spin.cross(arm)).norm());
  }
  return fastest;
}

double speed_of(const Body& body) {
  const double size = std::sqrt(body.inertia.trace() / body.mass);
  return body.velocity.norm() + body.spin.norm() * size;
}

double fastest(const std::function<AnchorPose(double)>& motion, double duration) {
  double most = 0.0;
  for (int i = 0; i <= kTimes; ++i) most = std::max(most, motion(duration * i / kTimes).velocity.norm());
  return most;
}

}  // namespace

double known_speed(const SceneFile& file) {
  double own = 0.0, driven = 0.0;
  for (const StartMotion& motion : file.start_motions)
    for (const std::size_t pair : motion.curve_pairs)
      own = std::max(own, speed_of(motion, file.scene.rods[pair]));
  for (const Body& body : file.scene.bodies) own = std::max(own, speed_of(body));
  for (const Anchor& anchor : file.scene.anchors)
    if (anchor.motion) own = std::max(own, fastest(anchor.motion, file.duration));
  for (const SceneBody& body : file.bodies)
    if (body.motion) driven = std::max(driven, fastest(body.motion, file.duration));
  return own + driven;
}

}  // namespace tendril::scene
