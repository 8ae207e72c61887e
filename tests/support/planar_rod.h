#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

/// The equations of motion of a rod clamped at its first node and moving in a plane, in the plane's own
/// terms: lengths and directions of the edges. It knows nothing of frames, directors or the library, and is
/// what their equations have to come to there.
namespace tendril::test {

using Vec2 = Eigen::Vector2d;

struct PlanarRod {
  std::vector<double> mass, bend;              ///< per node; bend is the spring of each adjacent edge
  std::vector<double> stretch, length, width;  ///< per edge
  std::vector<double> turn;  ///< per node, from edge to edge at rest; the first: the clamp's direction
  double damping = 0.0, viscosity = 0.0;
  Vec2 gravity = Vec2::Zero();
  Vec2 air = Vec2::Zero();
  double air_density = 0.0, normal_drag = 0.0, tangential_drag = 0.0;
  std::function<Vec2(const Vec2&)> push = {};  ///< force on a node, by its place
};

inline double direction(const Vec2& d) {
  return std::atan2(d.y(), d.x());
}
inline double wrapped(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

/// A homogeneous rod of circular section: E A / L, 2 E I / L_v, rho A times half the adjacent lengths.
inline PlanarRod planar_rod(const std::vector<Vec2>& rest, double young, double radius, double density) {
  const double area = std::numbers::pi * radius * radius, second = 0.25 * area * radius * radius;
  PlanarRod rod;
  double before = 0.0, last = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool inner = i + 1 < rest.size();
    const double after = inner ? (rest[i + 1] - rest[i]).norm() : 0.0;
    const double mean = (before + after) / (i > 0 && inner ? 2.0 : 1.0);
    rod.mass.push_back(density * area * 0.5 * (before + after));
    rod.bend.push_back(2.0 * young * second / mean);
    if (!inner) break;
    rod.length.push_back(after);
    rod.stretch.push_back(young * area / after);
    rod.width.push_back(2.0 * radius);
    const double now = direction(rest[i + 1] - rest[i]);
    rod.turn.push_back(wrapped(now - last));
    last = now;
    before = after;
  }
  return rod;
}

/// Per node, the first's too, as if nothing held it.
inline std::vector<Vec2> accelerations(const PlanarRod& rod, const std::vector<Vec2>& p,
                                       const std::vector<Vec2>& v) {
  const std::size_t edges = p.size() - 1;
  std::vector<Vec2> force(p.size(), Vec2::Zero());
  const auto pair = [&](std::size_t edge, const Vec2& f) {  // opposite forces at its ends
    force[edge] -= f;
    force[edge + 1] += f;
  };
  // A node's tangent halves the turn between its edges, so both of its springs are bent by half of it.
  double last = 0.0, last_rate = 0.0;
  Vec2 lever = Vec2::Zero();
  for (std::size_t e = 0; e < edges; ++e) {
    const Vec2 d = p[e + 1] - p[e], dv = v[e + 1] - v[e];
    const double length = d.norm();
    const Vec2 along = d / length, across(-along.y(), along.x());
    pair(e, -rod.stretch[e] * (length - rod.length[e] + rod.viscosity * along.dot(dv)) * along);

    const double now = direction(d), rate = across.dot(dv) / length;
    const double strain = wrapped(now - last - rod.turn[e]) + rod.viscosity * (rate - last_rate);
    const double couple = (e == 0 ? 1.0 : 0.5) * rod.bend[e] * strain;
    pair(e, -couple / length * across);
    if (e > 0) pair(e - 1, couple * lever);
    last = now;
    last_rate = rate;
    lever = across / length;

    const Vec2 wind = 0.5 * (v[e] + v[e + 1]) - rod.air;
    const double fast = wind.dot(along), wide = wind.dot(across);
    const Vec2 drag = rod.normal_drag * std::abs(wide) * wide * across +
                      rod.tangential_drag * std::abs(fast) * fast * along;
    for (const std::size_t end : {e, e + 1})
      force[end] -= 0.25 * rod.air_density * rod.width[e] * length * drag;
  }
  for (std::size_t i = 0; rod.push && i < p.size(); ++i) force[i] += rod.push(p[i]);
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < p.size(); ++i)
    out.push_back(force[i] / rod.mass[i] + rod.gravity - rod.damping * v[i]);
  return out;
}

}  // namespace tendril::test
