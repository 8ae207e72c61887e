#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "response.h"

namespace tendril::contact {
namespace {

/// What friction can hold: mu times the normal force, damping included.
struct Most {
  double value;
  Vec3 by_place, by_velocity;
};

Most most_of(const Law& law, const Normal& normal, const Vec3& n) {
  const double mu = law.friction;
  return {mu * normal.damped * normal.push,
          mu * (normal.damped * normal.by_place + normal.push * normal.damped_by_x),
          mu * normal.push * normal.damped_by_v * n};
}

/// Coulomb's law by a spring of stiffness k to the point where the surface sticks: with u the way from there
/// across the normal, s = u + beta u', the force is -k s while that is less than mu N, else mu N against s.
void add_friction(const Law& law, double k, const Nearness& near, const Vec3& n, const Mat3& bend,
                  const Normal& normal, const Vec3& from, const Vec3& velocity, Response& to) {
  const auto along = [&](const Vec3& y) -> Vec3 { return y - n.dot(y) * n; };
  const auto along_by_x = [&](const Vec3& y) -> Mat3 {
    return -n.dot(y) * bend - n * (bend * y).transpose();
  };
  const Mat3 across = Mat3::Identity() - n * n.transpose();
  const Vec3 y = near.x - near.placed->to_world(from), rate = velocity - near.placed->velocity_at(near.x);
  const Vec3 u = along(y), s = u + law.stick_damping * along(rate);
  const Mat3 by_v = law.stick_damping * across;
  const Mat3 by_x =
      across + along_by_x(y) + law.stick_damping * along_by_x(rate) - by_v * cross_matrix(near.placed->spin);
  const Most most = most_of(law, normal, n);
  to.sticks = k * s.norm() <= most.value;
  to.stick_at = from;
  if (to.sticks) {
    to.friction = -k * s;
    to.by_position += -k * by_x;
    to.by_velocity += -k * by_v;
  } else {
    const Vec3 way = s.normalized();
    const Mat3 turns = most.value / s.norm() * (Mat3::Identity() - way * way.transpose());
    to.friction = -most.value * way;
    to.by_position += -way * most.by_place.transpose() - turns * by_x;
    to.by_velocity += -way * most.by_velocity.transpose() - turns * by_v;
    const double far = kTrail * most.value / k;
    if (u.norm() > far) to.stick_at = near.placed->to_local(near.x - far * u.normalized());
  }
  to.force += to.friction;
}

}  // namespace

void refuse_closed(const Law& law, const std::string& what, double gap) {
  std::ostringstream told, expected;
  told.imbue(std::locale::classic());
  told << what << gap;
  expected.imbue(std::locale::classic());
  expected << "an open gap; what is " << law.range << " apart begins to be felt";
  throw InvalidInput("contact", told.str(), expected.str());
}

Normal push_of(const Law& law, double weight, double gap, const Vec3& n, const Mat3& bend, const Vec3& rate,
               const Vec3& spin) {
  const Potential b = potential(law, gap);
  const double k = weight * law.stiffness;
  Normal result{-k * b.slope, -k * b.bend * n, 1.0, Vec3::Zero(), 0.0};
  if (law.damping == 0.0) return result;
  result.damped = 1.0 - law.damping * n.dot(rate);
  if (result.damped <= 0.0) {
    result.damped = 0.0;
    return result;
  }
  result.damped_by_x = -law.damping * (bend * rate - n.cross(spin));
  result.damped_by_v = -law.damping;
  return result;
}

Mat3 by_position(const Normal& normal, const Vec3& n, const Mat3& bend) {
  return n * (normal.damped * normal.by_place + normal.push * normal.damped_by_x).transpose() +
         normal.damped * normal.push * bend;
}
Mat3 by_velocity(const Normal& normal, const Vec3& n) {
  return normal.push * normal.damped_by_v * n * n.transpose();
}

bool clear_way(const Shape& shape, const Nearness& near, const Vec3& before, double radius, double range) {
  const Vec3 way = before - near.local;
  const double length = way.norm();
  if (length < near.gap) return true;
  double s = near.gap;
  while (s < length) {
    const double gap = shape.distance(near.local + s / length * way) - radius;
    if (!(gap > 0.0)) return false;
    s += std::max(gap, 1e-4 * range);
  }
  return true;
}

Response respond(const Shape& shape, const Law& law, double weight, const Nearness& near,
                 const std::optional<Vec3>& from, const Vec3& velocity) {
  const SignedDistance at = shape.at(near.local);
  const Mat3& turn = near.placed->rotation;
  const Vec3 n = turn * at.normal;
  const Mat3 bend = turn * at.curvature * turn.transpose();
  const Vec3 rate = velocity - near.placed->velocity_at(near.x);
  const Normal normal = push_of(law, weight, near.gap, n, bend, rate, near.placed->spin);
  Response result{n, normal.damped * normal.push * n, Vec3::Zero(), false, near.local};
  result.by_position = by_position(normal, n, bend);
  result.by_velocity = by_velocity(normal, n);
  if (law.friction > 0.0 && from)
    add_friction(law, weight * stick_of(law), near, n, bend, normal, *from, velocity, result);
  return result;
}

}  // namespace tendril::contact
