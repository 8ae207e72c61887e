#include "edge_stiffness.h"

#include <cmath>

namespace tendril {
namespace {

using Model = System::Model;
using Workspace = System::Workspace;

/// Variables of one edge's springs: the unit edge, and tangent and angle at its two nodes.
constexpr int kE = 0;
constexpr int kSide[2] = {3, 7};  // t (3) then theta (1)
using SpringSpace = Eigen::Matrix<double, 11, 11>;
using SpringVector = Eigen::Matrix<double, 11, 1>;

Mat3 projector(const Vec3& n) {
  return Mat3::Identity() - n * n.transpose();
}

/// Second derivative of g.(d / |d|) by d, n = d / |d|.
Mat3 curvature_of_unit(const Vec3& n, double length, const Vec3& g) {
  const Vec3 across = g - g.dot(n) * n;
  return -(g.dot(n) * projector(n) + n * across.transpose() + across * n.transpose()) / (length * length);
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// First and second derivatives of one of the components e.l, e.m, e.t.
struct Component {
  SpringVector gradient = SpringVector::Zero();
  SpringSpace hessian = SpringSpace::Zero();

  void set(int row, int column, const Mat3& block) {
    hessian.block<3, 3>(row, column) = block;
    hessian.block<3, 3>(column, row) = block.transpose();
  }
  void set(int row, int column, const Vec3& block) {
    hessian.block<3, 1>(row, column) = block;
    hessian.block<1, 3>(column, row) = block.transpose();
  }
};

/// The frame carried by the smallest rotation to t = t_s + d, then turned by theta, to second order:
/// l: l - a t + theta m - a d / 2 - theta^2 l / 2 - theta b t,  m: m - b t - theta l - b d / 2 - theta^2 m /
/// 2 + theta a t, with a = d.l, b = d.m.
Component along_l(const Frame& f, const EdgeAngles& at, int t, int theta) {
  Component x;
  x.gradient.segment<3>(kE) = f.x;
  x.gradient.segment<3>(t) = -at.z * f.x;
  x.gradient[theta] = at.y;
  x.set(kE, t, Mat3(-f.z * f.x.transpose()));
  x.set(kE, theta, f.y);
  x.set(t, t,
        Mat3(-at.x * f.x * f.x.transpose() - 0.5 * at.y * (f.x * f.y.transpose() + f.y * f.x.transpose())));
  x.set(t, theta, Vec3(-at.z * f.y));
  x.hessian(theta, theta) = -at.x;
  return x;
}

Component along_m(const Frame& f, const EdgeAngles& at, int t, int theta) {
  Component y;
  y.gradient.segment<3>(kE) = f.y;
  y.gradient.segment<3>(t) = -at.z * f.y;
  y.gradient[theta] = -at.x;
  y.set(kE, t, Mat3(-f.z * f.y.transpose()));
  y.set(kE, theta, Vec3(-f.x));
  y.set(t, t,
        Mat3(-at.y * f.y * f.y.transpose() - 0.5 * at.x * (f.x * f.y.transpose() + f.y * f.x.transpose())));
  y.set(t, theta, Vec3(at.z * f.x));
  y.hessian(theta, theta) = -at.y;
  return y;
}

Component along_t(const Vec3& e, const Vec3& tangent, int t) {
  Component z;
  z.gradient.segment<3>(kE) = tangent;
  z.gradient.segment<3>(t) = e;
  z.set(kE, t, Mat3(Mat3::Identity()));
  return z;
}

/// Adds the spring W(q) with q one of the components: W'' grad grad^T + W' hess.
void add(const Component& q, double slope, double curvature, SpringSpace& s) {
  s += curvature * q.gradient * q.gradient.transpose() + slope * q.hessian;
}

/// Slope and curvature of 1/2 K (asin(q) - rest)^2; `cosine` that of the angle.
void add_deviation(const Component& q, double stiffness, double strain, double sine, double cosine,
                   SpringSpace& s) {
  const double slope = stiffness * strain / cosine;
  const double curvature = (stiffness + slope * sine) / (cosine * cosine);
  add(q, slope, curvature, s);
}

/// Slope and curvature of 1/2 K (acos(z) - rest)^2.
void add_angle(const Component& q, double stiffness, double angle, double rest, double sine, double z,
               SpringSpace& s) {
  if (sine > 1e-4) {
    const double g = stiffness * (angle - rest) / sine;
    add(q, -g, (stiffness - g * z) / (sine * sine), s);
  } else if (rest == 0.0) {
    // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5).
    add(q, -stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle), s);
  }
}

void add_bending(const Model& model, std::size_t i, std::size_t side, const Workspace& work, SpringSpace& s) {
  const std::size_t node = i + side;
  const std::size_t end = 2 * i + side;
  const int t = kSide[side];
  const Vec3& e = work.e[i];
  const Frame& f = work.frame[node];
  if (!model.has_twist(node)) {
    const double sine = e.cross(f.z).norm();
    const double z = e.dot(f.z);
    add_angle(along_t(e, f.z, t), model.bend_l[node] + model.bend_t[node], std::atan2(sine, z), 0.0, sine, z,
              s);
    return;
  }
  const EdgeAngles a = edge_angles(e, f);
  add_deviation(along_l(f, a, t, t + 3), model.bend_l[node], a.l - model.rest_l[end], a.x, a.cl, s);
  add_deviation(along_m(f, a, t, t + 3), model.bend_m[node], a.m - model.rest_m[end], a.y, a.cm, s);
  if (model.bend_t[node] > 0.0)
    add_angle(along_t(e, f.z, t), model.bend_t[node], a.t, model.rest_t[end], a.st, a.z, s);
}

SpringVector twist_gradient(const Vec3& c) {
  SpringVector g = SpringVector::Zero();
  g.segment<3>(kSide[0]) = c;
  g.segment<3>(kSide[1]) = c;
  g[kSide[0] + 3] = -1.0;
  g[kSide[1] + 3] = 1.0;
  return g;
}

/// tau = theta_b - theta_a + a function of the tangents, whose gradient away from the reference is
/// c + (t_s x t) / (1 + t_s.t) at a and c minus the like at b, c = (t_a x t_b) / (1 + t_a.t_b).
void add_twist(const Model& model, std::size_t i, const Workspace& work, double strain, SpringSpace& s) {
  const Vec3& ta = work.frame[i].z;
  const Vec3& tb = work.frame[i + 1].z;
  const double k = 1.0 + ta.dot(tb);
  const Vec3 c = ta.cross(tb) / k;
  Component tau;
  tau.gradient = twist_gradient(c);
  const Mat3 by_a = -(cross_matrix(tb) + c * tb.transpose()) / k;
  const Mat3 by_b = (cross_matrix(ta) - c * ta.transpose()) / k;
  const Mat3 pa = projector(ta);
  const Mat3 pb = projector(tb);
  const auto symmetric = [](const Mat3& m) { return Mat3(0.5 * (m + m.transpose())); };
  tau.set(kSide[0], kSide[0], symmetric(pa * (by_a + 0.5 * cross_matrix(ta)) * pa));
  tau.set(kSide[1], kSide[1], symmetric(pb * (by_b - 0.5 * cross_matrix(tb)) * pb));
  tau.set(kSide[0], kSide[1], Mat3(pa * by_b * pb));
  add(tau, model.twist[i] * strain, model.twist[i], s);
}

/// Derivatives of the springs' variables by the three unit edges around, then by the nodes.
struct Chain {
  Eigen::Matrix<double, 11, 11> to_edges =
      Eigen::Matrix<double, 11, 11>::Zero();  ///< e_{i-1}, e_i, e_{i+1}, thetas
  Eigen::Matrix<double, 11, 14> to_nodes = Eigen::Matrix<double, 11, 14>::Zero();
};

Chain chain(const Model& model, const NodeRange& rod, std::size_t i, const Workspace& work) {
  Chain c;
  c.to_edges.block<3, 3>(kE, 3).setIdentity();
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = i + side;
    if (model.holds_frame(node)) continue;
    const Mat3 share = projector(work.frame[node].z) / work.bisector[node];
    const auto before = static_cast<Eigen::Index>(3 * side);
    if (node > rod.first) c.to_edges.block<3, 3>(kSide[side], before) = share;
    if (node + 1 < rod.first + rod.count) c.to_edges.block<3, 3>(kSide[side], before + 3) = share;
    if (model.has_twist(node)) c.to_edges(kSide[side] + 3, static_cast<Eigen::Index>(9 + side)) = 1.0;
  }
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::size_t edge = i + static_cast<std::size_t>(k) - 1;
    if ((k == 0 && i == rod.first) || edge + 1 >= rod.first + rod.count) continue;
    const Mat3 share = projector(work.e[edge]) / work.length[edge];
    c.to_nodes.block<3, 3>(3 * k, 3 * k) = -share;
    c.to_nodes.block<3, 3>(3 * k, 3 * k + 3) = share;
  }
  c.to_nodes(9, 12) = 1.0;
  c.to_nodes(10, 13) = 1.0;
  return c;
}

/// Curvature of the tangent at node i (once per node: with the edge that begins there, the last node's with
/// the last edge) in the unit edges around.
void add_tangent_curvature(const Model& model, const NodeRange& rod, std::size_t i, const Workspace& work,
                           SpringSpace& s) {
  const auto add_at = [&](std::size_t node, Eigen::Index before) {
    if (model.holds_frame(node)) return;
    const Mat3 c = curvature_of_unit(work.frame[node].z, work.bisector[node], work.g_tangent[node]);
    const bool has_before = node > rod.first;
    const bool has_after = node + 1 < rod.first + rod.count;
    if (has_before) s.block<3, 3>(before, before) += c;
    if (has_after) s.block<3, 3>(before + 3, before + 3) += c;
    if (has_before && has_after) {
      s.block<3, 3>(before, before + 3) += c;
      s.block<3, 3>(before + 3, before) += c;
    }
  };
  add_at(i, 0);
  if (i + 2 == rod.first + rod.count) add_at(i + 1, 3);
}

void add_edge_curvature(const Model& model, std::size_t i, const Workspace& work, EdgeStiffness& k) {
  const Vec3& e = work.e[i];
  const double strain = work.length[i] - model.rest_length[i];
  const Mat3 stretch = model.stretch[i] * (e * e.transpose() + strain / work.length[i] * projector(e));
  const Mat3 c = curvature_of_unit(e, work.length[i], work.g_edge[i]) + stretch;
  k.block<3, 3>(3, 3) += c;
  k.block<3, 3>(6, 6) += c;
  k.block<3, 3>(3, 6) -= c;
  k.block<3, 3>(6, 3) -= c;
}

}  // namespace

EdgeStiffness edge_stiffness(const Model& model, const NodeRange& rod, std::size_t i, const State& reference,
                             const Workspace& work) {
  SpringSpace springs = SpringSpace::Zero();
  for (std::size_t side = 0; side < 2; ++side) add_bending(model, i, side, work, springs);
  if (model.has_twist(i)) {
    const double raw = twist_angle(work.frame[i], work.frame[i + 1]);
    const double tau = reference.twist[i] + std::remainder(raw - reference.twist[i], 2 * M_PI);
    add_twist(model, i, work, tau - model.rest_twist[i], springs);
  }
  const Chain c = chain(model, rod, i, work);
  SpringSpace edges = c.to_edges.transpose() * springs * c.to_edges;
  add_tangent_curvature(model, rod, i, work, edges);
  EdgeStiffness k = c.to_nodes.transpose() * edges * c.to_nodes;
  add_edge_curvature(model, i, work, k);
  return k;
}

EdgeStiffness edge_resistance(const Model& model, const NodeRange& rod, std::size_t i,
                              const Workspace& work) {
  SpringSpace springs = SpringSpace::Zero();
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = i + side;
    if (!model.has_twist(node)) continue;
    const int t = kSide[side];
    const EdgeAngles a = edge_angles(work.e[i], work.frame[node]);
    const SpringVector l = along_l(work.frame[node], a, t, t + 3).gradient / a.cl;
    const SpringVector m = along_m(work.frame[node], a, t, t + 3).gradient / a.cm;
    springs += model.bend_l[node] * l * l.transpose() + model.bend_m[node] * m * m.transpose();
  }
  if (model.has_twist(i)) {
    const Vec3& ta = work.frame[i].z;
    const Vec3& tb = work.frame[i + 1].z;
    const SpringVector g = twist_gradient(ta.cross(tb) / (1.0 + ta.dot(tb)));
    springs += model.twist[i] * g * g.transpose();
  }
  const Chain c = chain(model, rod, i, work);
  EdgeStiffness k = c.to_nodes.transpose() * (c.to_edges.transpose() * springs * c.to_edges) * c.to_nodes;
  const Mat3 stretch = model.stretch[i] * work.e[i] * work.e[i].transpose();
  k.block<3, 3>(3, 3) += stretch;
  k.block<3, 3>(6, 6) += stretch;
  k.block<3, 3>(3, 6) -= stretch;
  k.block<3, 3>(6, 3) -= stretch;
  return k;
}

std::array<Eigen::Index, 14> edge_places(const Model& model, const NodeRange& rod, std::size_t i) {
  std::array<Eigen::Index, 14> at{};
  at.fill(-1);
  for (std::size_t k = 0; k < 4; ++k) {
    if ((k == 0 && i == rod.first) || i + k > rod.first + rod.count) continue;
    const auto node = static_cast<Eigen::Index>(i + k - 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[3 * k + axis] = 3 * node + static_cast<Eigen::Index>(axis);
  }
  for (std::size_t side = 0; side < 2; ++side)
    if (model.has_twist(i + side)) at[12 + side] = model.v_begin() + model.twist_index[i + side];
  return at;
}

}  // namespace tendril
