#pragma once

#include <tendril/base/types.h>

namespace tendril {

/// A free rigid body: at rest or moving at the start, held by nothing. It has no shape; forces act on it
/// through Loads::bodies. Plain data; System checks it.
///
///     x' = u,  m u' = F + m g,  R' = [omega] R,  I omega' = T - omega x I omega,  I = R inertia R^T
struct Body {
  double mass = 1.0;  ///< positive
  /// About the centre of mass, in the body's axes [mass length^2]: symmetric, positive definite, no principal
  /// moment larger than the sum of the two others (to 1e-12 of the largest).
  Mat3 inertia = Mat3::Identity();
  Vec3 position = Vec3::Zero();      ///< of the centre of mass, in the world
  Mat3 rotation = Mat3::Identity();  ///< body to world; orthonormal to 1e-9, det 1; made so to rounding
  Vec3 velocity = Vec3::Zero();      ///< of the centre of mass
  Vec3 spin = Vec3::Zero();          ///< angular velocity, in the world [rad / time]
};

/// A body in a state, as forces see it.
struct BodyView {
  Vec3 position = Vec3::Zero();      ///< of the centre of mass, in the world
  Mat3 rotation = Mat3::Identity();  ///< body to world
  Vec3 velocity = Vec3::Zero();      ///< of the centre of mass
  Vec3 spin = Vec3::Zero();          ///< angular velocity, in the world
  double mass = 0.0;                 ///< its own
  /// The velocity of the body's matter at a point of the world.
  Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - position); }
};

/// What acts on a body, in the world.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< at it
  Vec3 torque = Vec3::Zero();  ///< about the centre of mass
  /// Adds a force that acts at a point of the world, on a body with its centre of mass at `centre`.
  void add_at(const Vec3& point, const Vec3& pull, const Vec3& centre) {
    force += pull;
    torque += (point - centre).cross(pull);
  }
};

}  // namespace tendril
