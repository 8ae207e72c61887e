#include "scene/solid/known_speed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace tendril::scene {
namespace {

constexpr int kTimes = 1000;

Vec3 centre_of(const StartMotion& motion, const Scene& scene) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (const std::size_t pair : motion.curve_pairs)
    for (std::size_t i = 0; i < scene.rods[pair].p.size(); ++i) {
      sum += scene.rods[pair].mass[i] * scene.rods[pair].p[i];
      mass += scene.rods[pair].mass[i];
    }
  return sum / mass;
}

/// Of curve-pairs that begin to move as one rigid body.
double speed_of(const StartMotion& motion, const Scene& scene) {
  const Vec3 about = motion.about ? *motion.about : centre_of(motion, scene);
  double fastest = 0.0;
  for (const std::size_t pair : motion.curve_pairs)
    for (const Vec3& p : scene.rods[pair].p)
      fastest = std::max(fastest, (motion.velocity + motion.spin.cross(p - about)).norm());
  return fastest;
}

double speed_of(const Body& body) {
  const double size = std::sqrt(body.inertia.trace() / body.mass);
  return body.velocity.norm() + body.spin.norm() * size;
}

/// Whether rods are held by no anchor, nor joined to one that is. Parents come before their children.
std::vector<bool> free_rods(const Scene& scene) {
  std::vector<bool> held(scene.rods.size(), false);
  for (const Anchor& anchor : scene.anchors) held[anchor.rod] = true;
  for (std::size_t k = scene.joints.size(); k-- > 0;)
    if (held[scene.joints[k].child]) held[scene.joints[k].parent] = true;
  for (const Joint& joint : scene.joints)
    if (held[joint.parent]) held[joint.child] = true;
  held.flip();
  return held;
}

double fastest(const std::function<AnchorPose(double)>& motion, double duration) {
  double most = 0.0;
  for (int i = 0; i <= kTimes; ++i) most = std::max(most, motion(duration * i / kTimes).velocity.norm());
  return most;
}

}  // namespace

double known_speed(const SceneFile& file) {
  double own = 0.0, driven = 0.0;
  for (const StartMotion& motion : file.start_motions) own = std::max(own, speed_of(motion, file.scene));
  for (const Body& body : file.scene.bodies) own = std::max(own, speed_of(body));
  for (const Anchor& anchor : file.scene.anchors)
    if (anchor.motion) own = std::max(own, fastest(anchor.motion, file.duration));
  for (const SceneBody& body : file.bodies)
    if (body.motion) driven = std::max(driven, fastest(body.motion, file.duration));
  return own + driven;
}

double known_fall(const SceneFile& file) {
  Vec3 down = Vec3::Zero();
  for (const auto& force : file.scene.forces)
    if (const auto a = force->uniform_acceleration()) down += *a;
  if (!(down.norm() > 0.0)) return 0.0;
  down.normalize();
  double highest = std::numeric_limits<double>::infinity(), lowest = -highest;
  const auto falls = [&](const Vec3& p) {
    highest = std::min(highest, down.dot(p));
    lowest = std::max(lowest, down.dot(p));
  };
  const std::vector<bool> free = free_rods(file.scene);
  for (std::size_t r = 0; r < free.size(); ++r)
    if (free[r])
      for (const Vec3& p : file.scene.rods[r].p) falls(p);
  for (const Body& body : file.scene.bodies) falls(body.position);
  for (const SceneBody& body : file.bodies) lowest = std::max(lowest, down.dot(body.pose.position));
  return std::max(0.0, lowest - highest);
}

}  // namespace tendril::scene
