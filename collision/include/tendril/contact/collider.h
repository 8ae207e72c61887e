#pragma once

#include <tendril/contact/shape.h>
#include <tendril/dynamics/force.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tendril::contact {

/// Where a solid's frame stands, and how it moves.
struct Placement {
  Mat3 rotation = Mat3::Identity();  ///< its axes, as columns: of the world from the solid's
  Vec3 position = Vec3::Zero();      ///< its origin in the world
  Vec3 velocity = Vec3::Zero();      ///< of the origin; what slides and what damps see it
  Vec3 spin = Vec3::Zero();          ///< angular velocity in the world's axes

  /// Coordinates in the solid's frame.
  Vec3 to_local(const Vec3& x) const { return rotation.transpose() * (x - position); }
  /// And back.
  Vec3 to_world(const Vec3& x) const { return rotation * x + position; }
  /// How fast a point of the solid at x moves.
  Vec3 velocity_at(const Vec3& x) const { return velocity + spin.cross(x - position); }
};

/// A solid that rods and bodies meet: fixed, driven in time, or a free rigid body of the scene, which feels
/// what it does.
struct Collider {
  std::string name;     ///< for reports; may be empty
  ShapePtr shape;       ///< not null
  Placement placement;  ///< where it stands, unless driven or a body
  /// Where it is at a time. Pure and continuous; empty for what is fixed.
  std::function<Placement(double time)> driven = {};
  std::vector<double> breaks = {};  ///< times where its velocity jumps: steps end there
  /// Index of the body of Scene::bodies whose shape this is: the frames are the same.
  std::optional<std::size_t> body = {};

  /// Where it is in a state.
  Placement at(const StateView& state) const {
    if (!body) return driven ? driven(state.time) : placement;
    const BodyView& at = state.bodies[*body];
    return {at.rotation, at.position, at.velocity, at.spin};
  }
  bool moves() const { return driven || body; }  ///< or stands still for ever
};

/// InvalidInput("contact.colliders[i].field") for a shape missing, a placement that is none, what is both
/// free and driven, and a hollow that has no room.
/// \param collider  to be checked
/// \param i         its index
/// \param thickest  radius of a ball that has to fit in its hollow
TENDRIL_CONTACT_API void check(const Collider& collider, std::size_t i, double thickest);

}  // namespace tendril::contact
