#include "held.h"

#include <cmath>

#include "dynamics/vector/lanes.h"
#include "kinematics.h"

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

/// The springs of the edge at `side` of a held node (0 before, 1 after), which makes these angles.
Given pull_at(const Model& model, const Held& at, std::size_t side, const EdgeAngles& by,
              const Kinematics& kin, const Gradient& grad) {
  const std::size_t i = at.node;
  const std::size_t edge = i + side - 1;
  const std::size_t end = 2 * edge + 1 - side;
  const Frame& f = at.frame;
  const Vec3 e = kin.e[edge];
  const double l = by.l - model.rest_l[end];
  const double m = by.m - model.rest_m[end];
  double fl = model.bend_l[i] * l;
  double fm = model.bend_m[i] * m;
  Given given;
  given.energy = 0.5 * (fl * l + fm * m);
  const Vec3 way = grad.given[i];
  fl -= (model.bend_l[i] + model.bend_t[i]) * way.x();
  fm -= (model.bend_m[i] + model.bend_t[i]) * way.y();
  if (at.viscous) {
    const double viscosity = model.viscosity[edge];
    const DeviationRates rate = deviation_rates(f, by, kin.rate.e_rate[edge], at.t_rate, at.spin);
    given.heat = viscosity * (model.bend_l[i] * rate.l * rate.l + model.bend_m[i] * rate.m * rate.m);
    fl += viscosity * model.bend_l[i] * rate.l;
    fm += viscosity * model.bend_m[i] * rate.m;
  }
  const double both = by.x * fl + by.y * fm;
  const double gl = by.ratio * fl + both * by.rise * by.x;
  const double gm = by.ratio * fm + both * by.rise * by.y;
  // d(angle) = -(de.t + e.dt) / sin(angle); at angle 0 the limit for a rest of 0, nothing at the tip of a
  // rest cone.
  const double rest = model.rest_t[end];
  const double third = by.t - rest;
  given.energy += 0.5 * model.bend_t[i] * third * third;
  double g = model.bend_t[i] * by.ratio;
  if (rest > 0.0) g = by.st > 1e-12 ? model.bend_t[i] * third / by.st : 0.0;
  g += both;
  const Vec3 across = gl * f.x + gm * f.y;
  given.edge = across - g * f.z;
  given.tangent = -by.z * across - g * e;
  given.spin = gl * by.y - gm * by.x;
  return given;
}

/// Whether the edge from node i on does so against the frame of a node at one of its ends.
bool turned_through(const State& reference, std::size_t node, std::size_t i, const Kinematics& kin) {
  const Vec3 e = kin.e[i];
  const Vec3 t = kin.frame.z[node];
  const double z = e.dot(t);
  if (!(z < -0.5)) return false;
  const Vec3 across = e - z * t;
  if (!(across.norm() >= kFoldBack)) return true;
  const auto place = [&](std::size_t k) {
    return Vec3(reference.y.segment<3>(3 * static_cast<Eigen::Index>(k)));
  };
  const Vec3 before = (place(i + 1) - place(i)).normalized();
  const Vec3& t_before = reference.tangent[node];
  const double z_before = before.dot(t_before);
  return z_before < -0.5 && across.dot(before - z_before * t_before) < 0.0;
}

}  // namespace

bool past_half_turn(const Model& model, const State& reference, std::size_t node, const Kinematics& kin) {
  if (model.bend_l[node] + model.bend_m[node] + model.bend_t[node] == 0.0) return false;
  return (model.has_before(node) && turned_through(reference, node, node - 1, kin)) ||
         (model.has_after(node) && turned_through(reference, node, node, kin));
}

double bend_at_held_frame(const Model& model, std::size_t node, bool viscous, const EdgeAngles* after,
                          const Kinematics& kin, Gradient& grad, double& heat) {
  const Held at{node, kin.frame[node], viscous ? kin.t_rate(node) : Vec3(Vec3::Zero()),
                viscous ? kin.spin[node] : 0.0, viscous};
  const auto pull = [&](std::size_t side, const EdgeAngles& by, Columns3& to) {
    const Given given = pull_at(model, at, side, by, kin, grad);
    to.set(node, given.edge);
    grad.tangent.add(node, given.tangent);
    grad.spin[node] += given.spin;
    heat += given.heat;
    return given.energy;
  };
  double energy = 0.0;
  if (model.has_before(node)) energy += pull(0, edge_angles(kin.e[node - 1], at.frame), grad.before);
  if (model.has_after(node))
    energy += pull(1, after ? *after : edge_angles(kin.e[node], at.frame), grad.after);
  return energy;
}

double bend_at_held_hinge(const Model& model, std::size_t node, const Kinematics& kin, Gradient& grad) {
  const Vec3 t = kin.frame.z[node];
  const double stiffness = model.bend_l[node] + model.bend_t[node];
  Vec3 g_tangent = Vec3::Zero();
  double energy = 0.0;
  const auto spring = [&](const Vec3& e) {
    const double square = e.cross(t).squaredNorm();
    const double sine = std::sqrt(square);
    const double cosine = e.dot(t);
    const bool near = cosine > 0.0 && square <= lanes::kNearSquare;
    // Straight against the frame an edge may stand where there is no spring.
    const double ratio = near         ? lanes::asin_ratio(square)
                         : sine > 0.0 ? std::atan2(sine, cosine) / sine
                                      : 1.0;
    const double g = stiffness * ratio;
    g_tangent -= g * e;
    energy += 0.5 * stiffness * ratio * ratio * square;
    return Vec3(-g * t);
  };
  if (model.has_before(node)) grad.before.set(node, spring(kin.e[node - 1]));
  if (model.has_after(node)) grad.after.set(node, spring(kin.e[node]));
  grad.tangent.set(node, g_tangent);
  return energy;
}

double give_way_at_hubs(const Model& model, bool viscous, const Kinematics& kin, Gradient& grad) {
  const auto strain = [&](std::size_t i) {
    if (viscous && model.viscosity[i] > 0.0) return grad.twist_strain[i];
    return model.twist[i] > 0.0 ? grad.twist_torque[i] / model.twist[i] : 0.0;
  };
  double energy = 0.0;
  std::size_t k = 0;
  for (const Model::Hub& hub : model.hubs) {
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (const Model::Hub::Child& child : hub.children) {
      const std::size_t i = child.root;
      const EdgeAngles& at = grad.child_edges[k++] = edge_angles(kin.e[i], kin.frame[i]);
      moment += child.moment * Vec3(at.l, at.m, strain(i));
    }
    const Eigen::Vector2d omega = hub.give * moment;
    energy -= 0.5 * moment.dot(omega);
    for (const Model::Hub::Child& child : hub.children) {
      const std::size_t i = child.root;
      const Vec3 way = child.turn * omega;
      grad.given.set(i, way);
      const double torque = model.twist[i] * way.z();
      const Vec3 ta = kin.frame.z[i];
      const Vec3 tb = kin.frame.z[i + 1];
      grad.twist_torque[i] -= torque;
      grad.twist_tangent.add(i, -torque / (1.0 + ta.dot(tb)) * ta.cross(tb));
    }
  }
  return energy;
}

}  // namespace tendril
