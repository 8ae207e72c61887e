#include "held.h"

#include <cmath>

#include "dynamics/vector/lanes.h"

namespace tendril {
namespace {

/// What the springs between a held frame and one edge give.
struct Given {
  Vec3 edge = Vec3::Zero(), tangent = Vec3::Zero();
  double spin = 0.0, energy = 0.0, heat = 0.0;
};

/// A held frame, and how it turns where springs are viscous.
struct Held {
  std::size_t node;
  Frame frame;
  Vec3 t_rate;
  double spin;
  bool viscous;
};

struct Deviations {
  lanes::Deviation l, m;
  double t;  ///< the angle to the tangent over its sine
};

/// The two deviations of a unit edge at components x, y, z, and the third angle.
Deviations deviations(double x, double y, double z) {
  const double across2 = x * x + y * y;
  if (across2 <= lanes::kNearSquare && z >= 0.0)
    return {{x * lanes::asin_ratio(x * x), lanes::inverse_cosine(x * x)},
            {y * lanes::asin_ratio(y * y), lanes::inverse_cosine(y * y)},
            lanes::asin_ratio(across2)};
  const double sine = std::sqrt(across2);
  return {lanes::deviation(x, std::sqrt(y * y + z * z)), lanes::deviation(y, std::sqrt(x * x + z * z)),
          sine > 1e-12 ? lanes::angle(sine, z) / sine : 1.0};
}

/// The springs of the edge at `side` of a held node (0 before, 1 after).
Given pull_at(const Model& model, const Held& at, std::size_t side, const Kinematics& kin) {
  const std::size_t i = at.node;
  const std::size_t edge = i + side - 1;
  const std::size_t end = 2 * edge + 1 - side;
  const Frame& f = at.frame;
  const Vec3 e = kin.e[edge];
  const double x = e.dot(f.x);
  const double y = e.dot(f.y);
  const double z = e.dot(f.z);
  const Deviations by = deviations(x, y, z);
  const double l = by.l.angle - model.rest_l[end];
  const double m = by.m.angle - model.rest_m[end];
  double fl = model.bend_l[i] * l;
  double fm = model.bend_m[i] * m;
  Given given;
  given.energy = 0.5 * (fl * l + fm * m);
  if (at.viscous) {
    // Rates with the frame turning by t' and w: m' = -(m.t') t - w l, l' = -(l.t') t + w m.
    const Vec3 e_rate = kin.rate.e_rate[edge];
    const double viscosity = model.viscosity[edge];
    const double l_rate = (e_rate.dot(f.x) - f.x.dot(at.t_rate) * z + at.spin * y) * by.l.inverse_cosine;
    const double m_rate = (e_rate.dot(f.y) - f.y.dot(at.t_rate) * z - at.spin * x) * by.m.inverse_cosine;
    given.heat = viscosity * (model.bend_l[i] * l_rate * l_rate + model.bend_m[i] * m_rate * m_rate);
    fl += viscosity * model.bend_l[i] * l_rate;
    fm += viscosity * model.bend_m[i] * m_rate;
  }
  const double gl = fl * by.l.inverse_cosine;
  const double gm = fm * by.m.inverse_cosine;
  // d(angle) = -(de.t + e.dt) / sin(angle); at angle 0 the limit for a rest of 0, nothing at the tip of a
  // rest cone.
  const double sine = std::sqrt(x * x + y * y);
  const double rest = model.rest_t[end];
  const double third = by.t * sine - rest;
  given.energy += 0.5 * model.bend_t[i] * third * third;
  double g = model.bend_t[i] * by.t;
  if (rest > 0.0) g = sine > 1e-12 ? model.bend_t[i] * third / sine : 0.0;
  const Vec3 across = gl * f.x + gm * f.y;
  given.edge = across - g * f.z;
  given.tangent = -z * across - g * e;
  given.spin = gl * y - gm * x;
  return given;
}

}  // namespace

double bend_at_held_frame(const Model& model, std::size_t node, bool viscous, const Kinematics& kin,
                          Gradient& grad, double& heat) {
  const Held at{node, kin.frame[node], viscous ? kin.t_rate(node) : Vec3(Vec3::Zero()),
                viscous ? kin.spin[node] : 0.0, viscous};
  const auto pull = [&](std::size_t side, Columns3& to) {
    const Given given = pull_at(model, at, side, kin);
    to.set(node, given.edge);
    grad.tangent.add(node, given.tangent);
    grad.spin[node] += given.spin;
    heat += given.heat;
    return given.energy;
  };
  double energy = 0.0;
  if (model.has_before(node)) energy += pull(0, grad.before);
  if (model.has_after(node)) energy += pull(1, grad.after);
  return energy;
}

double bend_at_held_hinge(const Model& model, std::size_t node, const Kinematics& kin, Gradient& grad) {
  const Vec3 t = kin.frame.z[node];
  const double stiffness = model.bend_l[node] + model.bend_t[node];
  Vec3 g_tangent = Vec3::Zero();
  double energy = 0.0;
  const auto spring = [&](const Vec3& e) {
    const double sine = e.cross(t).norm();
    const double angle = std::atan2(sine, e.dot(t));
    const double g = sine > 1e-12 ? stiffness * angle / sine : stiffness;
    g_tangent -= g * e;
    energy += 0.5 * stiffness * angle * angle;
    return Vec3(-g * t);
  };
  if (model.has_before(node)) grad.before.set(node, spring(kin.e[node - 1]));
  if (model.has_after(node)) grad.after.set(node, spring(kin.e[node]));
  grad.tangent.set(node, g_tangent);
  return energy;
}

}  // namespace tendril
