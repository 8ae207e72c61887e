#pragma once

#include <tendril/contact/collider.h>
#include <tendril/contact/law.h>

#include <optional>

namespace tendril::contact {

/// What a point, widened to a ball, is to a solid.
struct Nearness {
  std::size_t point, collider;
  Vec3 x;                   ///< in the world
  Vec3 local;               ///< in the solid's frame
  double gap;               ///< less the margin between points
  const Placement* placed;  ///< of the solid
  double radius;            ///< of the ball
};

/// What a solid does to a point in its range.
struct Response {
  Vec3 normal;    ///< of the solid, in the world
  Vec3 force;     ///< on the point, friction included
  Vec3 friction;  ///< of it
  bool sticks;
  Vec3 stick_at;  ///< where it would stick from here on, in the frame of the solid
  Mat3 by_position = Mat3::Zero(), by_velocity = Mat3::Zero();  ///< of the force
};

/// What slides drags its point behind it, farther than the spring would need, by this factor: else every
/// change of N would make it stick for a moment, and each accepted step begin with a kink. Where it turns
/// round, friction turns that much later.
constexpr double kTrail = 1.1;

/// Checked.
inline const Law& checked(const Law& law) {
  check(law, "contact.law");
  return law;
}
/// Throws InvalidInput for what begins without an open gap.
[[noreturn]] void refuse_closed(const Law& law, const std::string& what, double gap);
/// The stiffness of what sticks.
inline double stick_of(const Law& law) {
  return law.stick_stiffness > 0.0 ? law.stick_stiffness : law.stiffness;
}
/// Neither the time nor what was before enters.
inline bool conservative(const Law& law) {
  return law.friction == 0.0 && law.damping == 0.0;
}

/// [a] b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// The normal force m N n, N = -w kappa b', m = max(0, 1 - c d').
struct Normal {
  double push;         ///< N
  Vec3 by_place;       ///< dN / dx
  double damped;       ///< m
  Vec3 damped_by_x;    ///< dm / dx
  double damped_by_v;  ///< dm / dv is this times n
};
/// \param n     unit, away from what is met
/// \param bend  dn / dx
/// \param rate  velocity less that of what is met, there
/// \param spin  of what is met
Normal push_of(const Law& law, double weight, double gap, const Vec3& n, const Mat3& bend, const Vec3& rate,
               const Vec3& spin);
/// d(m N n) / dx and / dv.
Mat3 by_position(const Normal& normal, const Vec3& n, const Mat3& bend);
Mat3 by_velocity(const Normal& normal, const Vec3& n);

/// Whether the straight way of a point whose gap is open, from `before` in the solid's frame, keeps the gap
/// open: spheres of free space along the way back [Hart 1996]. A step over less than 1e-4 of the range may
/// pass what is thinner than that of the widened solid, and so lies within the point's own radius.
/// \param radius  by which the solid is widened
bool clear_way(const Shape& shape, const Nearness& near, const Vec3& before, double radius, double range);

/// \param from      where the point stuck, in the frame of the solid; empty for nowhere yet
/// \param velocity  of the point
Response respond(const Shape& shape, const Law& law, double weight, const Nearness& near,
                 const std::optional<Vec3>& from, const Vec3& velocity);

}  // namespace tendril::contact
