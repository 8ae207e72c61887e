#pragma once

#include <tendril/dynamics/body.h>

#include <string>
#include <vector>

namespace tendril {

/// What stays the same of a free body.
struct RigidBody {
  double mass;
  Mat3 inertia, inverse;  ///< in the body's axes
  Mat3 axes;              ///< its principal axes in the body's axes, columns
  Vec3 moments;           ///< about them
  bool isotropic;         ///< the same inertia about every axis, to rounding
  double size;            ///< radius of gyration, of the mean of the moments

  Mat3 inertia_at(const Mat3& rotation) const { return rotation * inertia * rotation.transpose(); }
};

/// Throws InvalidInput naming body and field.
std::vector<RigidBody> checked_bodies(const std::vector<Body>& bodies);

/// Whether a rotation is orthonormal to 1e-9, and none is mirrored.
bool is_rotation(const Mat3& r);

/// The nearest rotation to a matrix that nearly is one.
Mat3 nearest_rotation(const Mat3& r);

}  // namespace tendril
