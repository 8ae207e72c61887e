#include "elastic.h"

#include <cmath>

namespace tendril {
namespace {

using Outcome = Evaluation::Outcome;
using Workspace = System::Workspace;
using Model = System::Model;

/// Part of v across the unit vector n.
Vec3 across(const Vec3& n, const Vec3& v) {
  return v - n.dot(v) * n;
}

void place_nodes(const Model& model, double t, const Eigen::VectorXd& y, Workspace& work) {
  for (std::size_t a = 0; a < model.scene.anchors.size(); ++a) {
    const Anchor& anchor = model.scene.anchors[a];
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    work.pose[a] = anchor.motion
                       ? anchor.motion(t)
                       : AnchorPose{model.rest_p[i], model.rest_frame[i], Vec3::Zero(), Vec3::Zero()};
  }
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (model.holds_position(i) && model.anchor_index[i] >= 0) {
      const AnchorPose& pose = work.pose[static_cast<std::size_t>(model.anchor_index[i])];
      work.p[i] = pose.position;
      work.v[i] = pose.velocity;
    } else {
      work.p[i] = y.segment<3>(3 * static_cast<Eigen::Index>(i));
      work.v[i] = y.segment<3>(model.v_begin() + 3 * static_cast<Eigen::Index>(i));
    }
  }
}

/// The root of a child rod takes position and frame from the node it rides on, which is known by then.
void take_ride(const NodeRange& rod, const System::Model::Ride& ride, Workspace& work) {
  const std::size_t i = rod.first;
  work.p[i] = work.p[ride.parent];
  work.v[i] = work.v[ride.parent];
  const Frame& f = work.frame[ride.parent];
  const auto outside = [&](const Vec3& v) { return Vec3(v.x() * f.x + v.y() * f.y + v.z() * f.z); };
  work.frame[i] = {outside(ride.rest.x), outside(ride.rest.y), outside(ride.rest.z)};
  const Vec3 turning = f.z.cross(work.t_rate[ride.parent]) + work.spin[ride.parent] * f.z;
  work.t_rate[i] = turning.cross(work.frame[i].z);
  work.spin[i] = turning.dot(work.frame[i].z);
  work.connection[i] = 0.0;
}

Evaluation measure_edges(const NodeRange& rod, bool rates, Workspace& work) {
  for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
    const Vec3 d = work.p[i + 1] - work.p[i];
    work.length[i] = d.norm();
    if (!std::isfinite(work.length[i])) return {Outcome::not_finite, i};
    if (!(work.length[i] > 0.0)) return {Outcome::zero_edge, i};
    work.e[i] = d / work.length[i];
    if (!rates) continue;
    const Vec3 d_rate = work.v[i + 1] - work.v[i];
    work.length_rate[i] = work.e[i].dot(d_rate);
    work.e_rate[i] = across(work.e[i], d_rate) / work.length[i];
  }
  return {};
}

void take_held_frame(const Model& model, std::size_t i, Workspace& work) {
  if (model.anchor_index[i] < 0) return;  // riding on a parent: see take_ride
  const AnchorPose& pose = work.pose[static_cast<std::size_t>(model.anchor_index[i])];
  work.frame[i] = pose.frame;
  work.t_rate[i] = pose.angular_velocity.cross(pose.frame.z);
  work.spin[i] = pose.angular_velocity.dot(pose.frame.z);
  work.connection[i] = 0.0;
}

/// Tangent of a free node from its edges (2.7, normalised), with its rate.
Evaluation take_tangent(const NodeRange& rod, std::size_t i, bool rates, Workspace& work) {
  Vec3 sum = Vec3::Zero();
  Vec3 sum_rate = Vec3::Zero();
  if (i > rod.first) {
    sum += work.e[i - 1];
    if (rates) sum_rate += work.e_rate[i - 1];
  }
  if (i + 1 < rod.first + rod.count) {
    sum += work.e[i];
    if (rates) sum_rate += work.e_rate[i];
  }
  work.bisector[i] = sum.norm();
  if (work.bisector[i] < 1e-9) return {Outcome::fold_back, i};
  work.frame[i].z = sum / work.bisector[i];
  if (rates) work.t_rate[i] = across(work.frame[i].z, sum_rate) / work.bisector[i];
  return {};
}

/// Director of a free node with twist: the reference carried to the tangent, turned by theta.
Evaluation take_director(const Model& model, const State& reference, const Eigen::VectorXd& y, std::size_t i,
                         Workspace& work) {
  Frame& frame = work.frame[i];
  const Vec3& from = reference.tangent[i];
  const double cosine_plus_one = 1.0 + from.dot(frame.z);
  // Within a step no tangent turns further than 126 degrees: a longer way could take the wrong side.
  if (!(cosine_plus_one > 0.4)) return {Outcome::turned_too_far, i};
  const Eigen::Index k = model.twist_index[i];
  const double theta = y[model.theta_begin() + k];
  const Vec3 carried = rotate_smallest(from, frame.z, reference.director[i]);
  frame.y = std::cos(theta) * carried + std::sin(theta) * frame.z.cross(carried);
  frame.x = frame.y.cross(frame.z);
  work.spin[i] = y[model.spin_begin() + k];
  work.connection[i] = from.cross(frame.z).dot(work.t_rate[i]) / cosine_plus_one;
  return {};
}

Evaluation take_frames(const Model& model, const State& reference, const Eigen::VectorXd& y,
                       const NodeRange& rod, bool rates, Workspace& work) {
  for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) {
    if (model.holds_frame(i)) {
      take_held_frame(model, i, work);
      continue;
    }
    work.t_rate[i].setZero();
    if (const Evaluation at = take_tangent(rod, i, rates, work); !at.ok()) return at;
    work.spin[i] = 0.0;
    work.connection[i] = 0.0;
    if (!model.has_twist(i)) continue;
    if (const Evaluation at = take_director(model, reference, y, i, work); !at.ok()) return at;
  }
  return {};
}

/// The three angular springs of 3.2.3 between the unit edge i and the frame of its node i + side.
struct BendingSprings {
  double l, m, t;  ///< stiffness
  double rest_l, rest_m, rest_t;
  double viscosity;
};

double bend_with_director(const BendingSprings& k, std::size_t i, std::size_t node, Workspace& work,
                          double& dissipated) {
  const Frame& f = work.frame[node];
  const Vec3& e = work.e[i];
  const EdgeAngles a = edge_angles(e, f);
  double fl = k.l * (a.l - k.rest_l);
  double fm = k.m * (a.m - k.rest_m);
  double energy = 0.5 * (fl * (a.l - k.rest_l) + fm * (a.m - k.rest_m));
  if (k.viscosity > 0.0) {
    // Rates with the frame turning by t' and w: m' = -(m.t') t - w l, l' = -(l.t') t + w m.
    const Vec3& t_rate = work.t_rate[node];
    const double w = work.spin[node];
    const double l_rate = (work.e_rate[i].dot(f.x) - f.x.dot(t_rate) * a.z + w * a.y) / a.cl;
    const double m_rate = (work.e_rate[i].dot(f.y) - f.y.dot(t_rate) * a.z - w * a.x) / a.cm;
    dissipated += k.viscosity * (k.l * l_rate * l_rate + k.m * m_rate * m_rate);
    fl += k.viscosity * k.l * l_rate;
    fm += k.viscosity * k.m * m_rate;
  }
  const double gl = fl / a.cl;
  const double gm = fm / a.cm;
  work.g_edge[i] += gl * f.x + gm * f.y;
  work.g_tangent[node] -= a.z * (gl * f.x + gm * f.y);
  work.g_spin[node] += gl * a.y - gm * a.x;
  if (k.t > 0.0) {
    const double strain = a.t - k.rest_t;
    energy += 0.5 * k.t * strain * strain;
    // d(angle) = -(de.t + e.dt) / sin(angle); at angle 0 the limit for a rest of 0, nothing at the tip of a
    // rest cone.
    const double g = a.st > 1e-12 ? k.t * strain / a.st : (k.rest_t == 0.0 ? k.t : 0.0);
    work.g_edge[i] -= g * f.z;
    work.g_tangent[node] -= g * e;
  }
  return energy;
}

/// Without a twist state bending is isotropic and straight at rest: 1/2 K angle^2 needs no director.
double bend_by_angle(double stiffness, std::size_t i, std::size_t node, Workspace& work) {
  const Vec3& t = work.frame[node].z;
  const Vec3& e = work.e[i];
  const double sine = e.cross(t).norm();
  const double angle = std::atan2(sine, e.dot(t));
  const double g = sine > 1e-12 ? stiffness * angle / sine : stiffness;
  work.g_edge[i] -= g * t;
  work.g_tangent[node] -= g * e;
  return 0.5 * stiffness * angle * angle;
}

double bend(const Model& model, bool viscous, std::size_t i, Workspace& work, double& dissipated) {
  double energy = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = i + side;
    const std::size_t end = 2 * i + side;
    if (model.has_twist(node)) {
      const BendingSprings springs{model.bend_l[node],
                                   model.bend_m[node],
                                   model.bend_t[node],
                                   model.rest_l[end],
                                   model.rest_m[end],
                                   model.rest_t[end],
                                   viscous ? model.viscosity[i] : 0.0};
      energy += bend_with_director(springs, i, node, work, dissipated);
    } else {
      energy += bend_by_angle(model.bend_l[node] + model.bend_t[node], i, node, work);
    }
  }
  return energy;
}

double stretch(const Model& model, bool viscous, std::size_t i, Workspace& work, double& dissipated) {
  const double strain = work.length[i] - model.rest_length[i];
  work.g_length[i] = model.stretch[i] * strain;
  if (viscous) {
    const double resistance = model.viscosity[i] * model.stretch[i] * work.length_rate[i];
    dissipated += resistance * work.length_rate[i];
    work.g_length[i] += resistance;
  }
  return 0.5 * model.stretch[i] * strain * strain;
}

double twist(const Model& model, const State& reference, bool viscous, std::size_t i, Workspace& work,
             double& dissipated) {
  const Frame& a = work.frame[i];
  const Frame& b = work.frame[i + 1];
  const double raw = twist_angle(a, b);
  const double tau = reference.twist[i] + std::remainder(raw - reference.twist[i], 2 * M_PI);
  const double strain = tau - model.rest_twist[i];
  double torque = model.twist[i] * strain;
  // d tau = s_b - s_a + c.(dt_a + dt_b): what the smallest rotation between the tangents turns by itself.
  const Vec3 c = a.z.cross(b.z) / (1.0 + a.z.dot(b.z));
  if (viscous) {
    const double rate = work.spin[i + 1] - work.spin[i] + c.dot(work.t_rate[i] + work.t_rate[i + 1]);
    const double resistance = model.viscosity[i] * model.twist[i] * rate;
    dissipated += resistance * rate;
    torque += resistance;
  }
  work.g_spin[i] -= torque;
  work.g_spin[i + 1] += torque;
  work.g_tangent[i] += torque * c;
  work.g_tangent[i + 1] += torque * c;
  return 0.5 * model.twist[i] * strain * strain;
}

/// What the root of a child rod feels goes to the node it rides on: the force, and the torque T by
/// phi.T = g_t.(phi x t_0) + g_s phi.t_0 for the turn phi = t x dt + ds t of the parent's frame.
void pass_on(const NodeRange& rod, const System::Model::Ride& ride, Workspace& work) {
  if (!ride.reaction) return;
  const std::size_t i = rod.first;
  const Vec3& t0 = work.frame[i].z;
  const Vec3& t = work.frame[ride.parent].z;
  const Vec3 torque = t0.cross(work.g_tangent[i]) + (work.g_spin[i] - work.torque[i].dot(t0)) * t0;
  work.g_tangent[ride.parent] += torque.cross(t);
  work.g_spin[ride.parent] += torque.dot(t);
  work.force[ride.parent] += work.force[i];
  work.force[i].setZero();
  work.torque[i].setZero();
  work.g_tangent[i].setZero();
  work.g_spin[i] = 0.0;
}

void pull_back(const Model& model, const NodeRange& rod, Workspace& work) {
  const std::size_t last = rod.first + rod.count - 1;
  for (std::size_t i = rod.first; i <= last; ++i) {
    if (model.holds_frame(i)) continue;
    const Vec3 g = across(work.frame[i].z, work.g_tangent[i]) / work.bisector[i];
    if (i > rod.first) work.g_edge[i - 1] += g;
    if (i < last) work.g_edge[i] += g;
  }
  for (std::size_t i = rod.first; i < last; ++i) {
    const Vec3 f = across(work.e[i], work.g_edge[i]) / work.length[i] + work.g_length[i] * work.e[i];
    work.force[i] += f;
    work.force[i + 1] -= f;
  }
}

}  // namespace

System::Workspace::Workspace(const Model& model) : pose(model.scene.anchors.size()) {
  const std::size_t n = model.nodes;
  for (auto* vectors : {&p, &v, &e, &e_rate, &t_rate, &g_edge, &g_tangent, &force, &torque, &tangent})
    vectors->assign(n, Vec3::Zero());
  frame.assign(n, Frame{});
  for (auto* numbers : {&length, &length_rate, &bisector, &spin, &connection, &g_length, &g_spin})
    numbers->assign(n, 0.0);
}

Evaluation kinematics(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      bool rates, Workspace& work) {
  if (!y.allFinite()) return {Outcome::not_finite, 0};
  place_nodes(model, t, y, work);
  for (const std::size_t r : model.order) {
    const NodeRange& rod = model.rods[r];
    if (const System::Model::Ride* ride = model.ride_of(r)) take_ride(rod, *ride, work);
    if (const Evaluation at = measure_edges(rod, rates, work); !at.ok()) return at;
    if (const Evaluation at = take_frames(model, reference, y, rod, rates, work); !at.ok()) return at;
  }
  return {};
}

void relax(Workspace& work) {
  for (auto* vectors : {&work.g_edge, &work.g_tangent})
    std::fill(vectors->begin(), vectors->end(), Vec3::Zero());
  for (auto* numbers : {&work.g_length, &work.g_spin}) std::fill(numbers->begin(), numbers->end(), 0.0);
}

double elastic(const Model& model, const State& reference, bool viscous, Workspace& work,
               double& dissipated) {
  double energy = 0.0;
  dissipated = 0.0;
  relax(work);
  for (const NodeRange& rod : model.rods) {
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      energy += stretch(model, viscous, i, work, dissipated);
      energy += bend(model, viscous, i, work, dissipated);
      if (model.has_twist(i)) energy += twist(model, reference, viscous, i, work, dissipated);
    }
  }
  return energy;
}

void add_pulled_back(const Model& model, Workspace& work) {
  for (auto r = model.order.rbegin(); r != model.order.rend(); ++r) {
    pull_back(model, model.rods[*r], work);
    if (const System::Model::Ride* ride = model.ride_of(*r)) pass_on(model.rods[*r], *ride, work);
  }
}

}  // namespace tendril
