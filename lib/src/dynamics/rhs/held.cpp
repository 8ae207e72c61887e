#include "held.h"

#include <cmath>

#include "dynamics/vector/column_access.h"
#include "kinematics.h"

namespace tendril {
namespace {

using lanes::NodeAxes;
using lanes::Reader;
using lanes::V3;

/// What the springs between a held frame and one edge give.
struct Given {
  V3 edge{}, tangent{};
  double spin = 0.0, energy = 0.0, heat = 0.0;
};

TENDRIL_INLINE NodeAxes axes_at(std::size_t i, const Kinematics& kin) {
  const V3 m = Reader(kin.frame.y).at(i), t = Reader(kin.frame.z).at(i);
  return {lanes::cross(m, t), m, t};
}

/// The springs of the edge at `side` of a held node (0 before, 1 after), which makes these angles.
template <bool Viscous>
TENDRIL_INLINE Given pull_at(const Model& model, std::size_t i, const NodeAxes& f, std::size_t side,
                             const EdgeAngles& by, const Kinematics& kin, const Gradient& grad) {
  const std::size_t edge = i + side - 1;
  const std::size_t end = 2 * edge + 1 - side;
  const V3 e = Reader(kin.e).at(edge);
  const double l = by.l - model.rest_l[end];
  const double m = by.m - model.rest_m[end];
  double fl = model.bend_l[i] * l;
  double fm = model.bend_m[i] * m;
  Given given;
  given.energy = 0.5 * (fl * l + fm * m);
  const V3 way = Reader(grad.given).at(i);
  fl -= (model.bend_l[i] + model.bend_t[i]) * way.x;
  fm -= (model.bend_m[i] + model.bend_t[i]) * way.y;
  if constexpr (Viscous) {
    const double viscosity = model.viscosity[edge];
    const V3 t_rate = lanes::cross(Reader(kin.rate.turning).at(i), f.t);
    const DeviationRates rate =
        lanes::deviation_rates(f, by, Reader(kin.rate.e_rate).at(edge), t_rate, kin.spin[i]);
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
  const V3 across = gl * f.l + gm * f.m;
  given.edge = across - g * f.t;
  given.tangent = (-by.z) * across - g * e;
  given.spin = gl * by.y - gm * by.x;
  return given;
}

/// Adds what the springs of both edges give.
/// \param after  angles of the edge after the node, where they are known; else null
template <bool Viscous>
TENDRIL_INLINE double bend_at(const Model& model, std::size_t node, const EdgeAngles* after,
                              const Kinematics& kin, Gradient& grad, double& heat) {
  const NodeAxes frame = axes_at(node, kin);
  Given sum;
  if (model.has_before(node)) {
    const EdgeAngles by = lanes::edge_angles(Reader(kin.e).at(node - 1), frame);
    sum = pull_at<Viscous>(model, node, frame, 0, by, kin, grad);
    lanes::Writer(grad.before).put(node, sum.edge);
  }
  if (model.has_after(node)) {
    const EdgeAngles by = after ? *after : lanes::edge_angles(Reader(kin.e).at(node), frame);
    const Given given = pull_at<Viscous>(model, node, frame, 1, by, kin, grad);
    lanes::Writer(grad.after).put(node, given.edge);
    sum.tangent = sum.tangent + given.tangent;
    sum.spin += given.spin;
    sum.energy += given.energy;
    sum.heat += given.heat;
  }
  lanes::Writer(grad.tangent).add(node, sum.tangent);
  grad.spin[node] += sum.spin;
  heat += sum.heat;
  return sum.energy;
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

TENDRIL_LANES double bend_at_held_frame(const Model& model, std::size_t node, bool viscous,
                                        const EdgeAngles* after, const Kinematics& kin, Gradient& grad,
                                        double& heat) {
  return viscous ? bend_at<true>(model, node, after, kin, grad, heat)
                 : bend_at<false>(model, node, after, kin, grad, heat);
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

TENDRIL_LANES double give_way_at_hubs(const Model& model, bool viscous, const Kinematics& kin,
                                      Gradient& grad) {
  const auto strain = [&](std::size_t i) {
    if (viscous && model.viscosity[i] > 0.0) return grad.twist_strain[i];
    return model.twist[i] > 0.0 ? grad.twist_torque[i] / model.twist[i] : 0.0;
  };
  const Reader e(kin.e), t(kin.frame.z);
  double energy = 0.0;
  std::size_t k = 0;
  for (const Model::Hub& hub : model.hubs) {
    double ml = 0.0, mm = 0.0;  // moment
    for (const Model::Hub::Child& child : hub.children) {
      const std::size_t i = child.root;
      const EdgeAngles& at = grad.child_edges[k++] = lanes::edge_angles(e.at(i), axes_at(i, kin));
      const double s = strain(i);
      const auto& by = child.moment;
      ml += by(0, 0) * at.l + by(0, 1) * at.m + by(0, 2) * s;
      mm += by(1, 0) * at.l + by(1, 1) * at.m + by(1, 2) * s;
    }
    const double ol = hub.give(0, 0) * ml + hub.give(0, 1) * mm;  // omega
    const double om = hub.give(1, 0) * ml + hub.give(1, 1) * mm;
    energy -= 0.5 * (ml * ol + mm * om);
    for (const Model::Hub::Child& child : hub.children) {
      const std::size_t i = child.root;
      const auto& by = child.turn;
      const V3 way{by(0, 0) * ol + by(0, 1) * om, by(1, 0) * ol + by(1, 1) * om,
                   by(2, 0) * ol + by(2, 1) * om};
      lanes::Writer(grad.given).put(i, way);
      const double torque = model.twist[i] * way.z;
      const V3 ta = t.at(i), tb = t.at(i + 1);
      grad.twist_torque[i] -= torque;
      lanes::Writer(grad.twist_tangent).add(i, (-torque / (1.0 + lanes::dot(ta, tb))) * lanes::cross(ta, tb));
    }
  }
  return energy;
}

}  // namespace tendril
