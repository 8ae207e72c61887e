#pragma once

#include <tendril/contact/shape.h>

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

/// A solid that rods and surfaces meet: fixed, or driven in time. What it does to them it does not feel.
struct Collider {
  std::string name;     ///< for reports; may be empty
  ShapePtr shape;       ///< not null
  Placement placement;  ///< where it stands, unless driven
  /// Where it is at a time. Pure and continuous; empty for what is fixed.
  std::function<Placement(double time)> driven = {};
  std::vector<double> breaks = {};  ///< times where its velocity jumps: steps end there

  /// At a time.
  Placement at(double time) const { return driven ? driven(time) : placement; }
};

}  // namespace tendril::contact
