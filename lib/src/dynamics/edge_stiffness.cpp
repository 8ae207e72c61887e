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

/// First and second derivatives of an edge's springs by those variables.
struct Springs {
  SpringVector gradient = SpringVector::Zero();
  SpringSpace hessian = SpringSpace::Zero();
};

/// Adds the spring W(q) with q one of the components: W'' grad grad^T + W' hess.
void add(const Component& q, double slope, double curvature, Springs& s) {
  s.gradient += slope * q.gradient;
  s.hessian += curvature * q.gradient * q.gradient.transpose() + slope * q.hessian;
}

/// Slope and curvature of 1/2 K (asin(q) - rest)^2; `cosine` that of the angle.
void add_deviation(const Component& q, double stiffness, double strain, double sine, double cosine,
                   Springs& s) {
  const double slope = stiffness * strain / cosine;
  const double curvature = (stiffness + slope * sine) / (cosine * cosine);
  add(q, slope, curvature, s);
}

/// Slope and curvature of 1/2 K (acos(z) - rest)^2.
void add_angle(const Component& q, double stiffness, double angle, double rest, double sine, double z,
               Springs& s) {
  if (sine > 1e-4) {
    const double g = stiffness * (angle - rest) / sine;
    add(q, -g, (stiffness - g * z) / (sine * sine), s);
  } else if (rest == 0.0) {
    // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5).
    add(q, -stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle), s);
  }
}

void add_bending(const Model& model, std::size_t i, std::size_t side, const Workspace& work, Springs& s) {
  const std::size_t node = i + side;
  const std::size_t end = 2 * i + side;
  const int t = kSide[side];
  const Vec3 e = work.e[i];
  const Frame f = work.frame[node];
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
void add_twist(const Model& model, std::size_t i, const Workspace& work, double strain, Springs& s) {
  const Vec3 ta = work.frame.z[i];
  const Vec3 tb = work.frame.z[i + 1];
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

/// Turns the derivatives by the root frame's own (t_0, theta_0) into those by (t, theta) of the frame it is
/// fixed to. With d = t' - t the frame turns by phi = t x d + theta t + theta d / 2, which takes t_0 by
/// phi x t_0 + phi x (phi x t_0) / 2 and theta_0 by phi . t_0, all to second order.
void ride(const Vec3& t, const Vec3& t0, Springs& s) {
  const Vec3 g = s.gradient.segment<3>(kSide[0]);
  const double g_theta = s.gradient[kSide[0] + 3];
  Eigen::Matrix<double, 4, 4> first;
  first.topLeftCorner<3, 3>() = t0.dot(t) * Mat3::Identity() - t * t0.transpose();
  first.topRightCorner<3, 1>() = t.cross(t0);
  first.bottomLeftCorner<1, 3>() = t0.cross(t).transpose();
  first(3, 3) = t0.dot(t);
  SpringSpace chain = SpringSpace::Identity();
  chain.block<4, 4>(kSide[0], kSide[0]) = first;
  s.hessian = (chain.transpose() * s.hessian * chain).eval();
  s.gradient = (chain.transpose() * s.gradient).eval();

  Eigen::Matrix<double, 3, 4> phi;
  phi << cross_matrix(t), t;
  const Mat3 outer = 0.5 * (g * t0.transpose() + t0 * g.transpose()) - g.dot(t0) * Mat3::Identity();
  s.hessian.block<4, 4>(kSide[0], kSide[0]) += phi.transpose() * outer * phi;
  const Vec3 mixed = 0.5 * projector(t) * (t0.cross(g) + g_theta * t0);
  s.hessian.block<3, 1>(kSide[0], kSide[0] + 3) += mixed;
  s.hessian.block<1, 3>(kSide[0] + 3, kSide[0]) += mixed.transpose();
}

/// The edges that the tangents at the two ends of edge i halve, and the nodes and angles they stand on. The
/// tangent at a child's root is that of the node it rides on.
struct Neighbourhood {
  std::array<std::size_t, 2> frame_of;  ///< node whose tangent and angle count
  bool rides;                           ///< the first of them is another rod's
  Eigen::Index own, last;               ///< places of edge i and of the one after it among the edges below
};

/// Derivatives of the springs' variables by the unit edges around, then by the nodes. Edges: without a ride
/// e_{i-1}, e_i, e_{i+1} of nodes i-1 to i+2; with one the two of the carrying node, then e_i, e_{i+1}.
struct Chain {
  Eigen::Matrix<double, 11, 14> to_edges = Eigen::Matrix<double, 11, 14>::Zero();  ///< four edges, two angles
  Eigen::Matrix<double, 14, 17> to_nodes = Eigen::Matrix<double, 14, 17>::Zero();
};

Neighbourhood neighbourhood(const Model& model, const NodeRange& rod, std::size_t i) {
  const bool rides = i == rod.first && model.carrier[i] != i;
  return {{rides ? model.carrier[i] : i, i + 1}, rides, rides ? 2 : 1, rides ? 3 : 2};
}

void chain_edge(std::size_t edge, Eigen::Index place, Eigen::Index from, Eigen::Index to,
                const Workspace& work, Chain& c) {
  const Mat3 share = projector(work.e[edge]) * work.inverse_length[edge];
  c.to_nodes.block<3, 3>(3 * place, 3 * from) = -share;
  c.to_nodes.block<3, 3>(3 * place, 3 * to) = share;
}

Chain chain(const Model& model, const Neighbourhood& n, std::size_t i, const Workspace& work) {
  Chain c;
  c.to_edges.block<3, 3>(kE, 3 * n.own).setIdentity();
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = n.frame_of[side];
    if (model.holds_frame(node)) continue;
    const Mat3 share = projector(work.frame.z[node]) * work.inverse_bisector[node];
    const Eigen::Index before = side == 0 ? 0 : 3 * n.own;
    const Eigen::Index after = side == 0 ? 3 : 3 * n.last;
    if (model.has_before(node)) c.to_edges.block<3, 3>(kSide[side], before) = share;
    if (model.has_after(node)) c.to_edges.block<3, 3>(kSide[side], after) = share;
    c.to_edges(kSide[side] + 3, static_cast<Eigen::Index>(12 + side)) = 1.0;
  }
  const std::size_t first = n.frame_of[0];
  if (model.has_before(first)) chain_edge(first - 1, 0, 0, 1, work, c);
  if (n.rides) {
    if (model.has_after(first)) chain_edge(first, 1, 1, 2, work, c);
    chain_edge(i, 2, 1, 3, work, c);
    if (model.has_after(i + 1)) chain_edge(i + 1, 3, 3, 4, work, c);
  } else {
    chain_edge(i, 1, 1, 2, work, c);
    if (model.has_after(i + 1)) chain_edge(i + 1, 2, 2, 3, work, c);
  }
  c.to_nodes(12, 15) = 1.0;
  c.to_nodes(13, 16) = 1.0;
  return c;
}

/// Curvature of the tangent at node i (once per node: with the edge that begins there, the last node's with
/// the last edge) in the unit edges around.
void add_tangent_curvature(const Model& model, const Neighbourhood& n, std::size_t i, const Workspace& work,
                           Eigen::Matrix<double, 14, 14>& s) {
  const auto add_at = [&](std::size_t node, Eigen::Index before, Eigen::Index after) {
    if (model.holds_frame(node)) return;
    const Mat3 c =
        curvature_of_unit(work.frame.z[node], 1.0 / work.inverse_bisector[node], work.g_tangent[node]);
    if (model.has_before(node)) s.block<3, 3>(before, before) += c;
    if (model.has_after(node)) s.block<3, 3>(after, after) += c;
    if (model.has_before(node) && model.has_after(node)) {
      s.block<3, 3>(before, after) += c;
      s.block<3, 3>(after, before) += c;
    }
  };
  if (!n.rides) add_at(i, 0, 3);
  if (!model.has_after(i + 1)) add_at(i + 1, 3 * n.own, 3 * n.last);
}

/// Adds second derivatives by the vector along edge i.
void add_own_edge(const Neighbourhood& n, const Mat3& c, EdgeStiffness& to) {
  const Eigen::Index a = 3;
  const Eigen::Index b = n.rides ? 9 : 6;
  to.k.block<3, 3>(a, a) += c;
  to.k.block<3, 3>(b, b) += c;
  to.k.block<3, 3>(a, b) -= c;
  to.k.block<3, 3>(b, a) -= c;
}

/// Where the positions and angles of a neighbourhood stand, and whether their rows act.
void place(const Model& model, const Neighbourhood& n, std::size_t i, EdgeStiffness& to) {
  to.node.fill(EdgeStiffness::kNone);
  const auto set = [&](std::size_t slot, std::size_t node, bool there, bool through_joint) {
    if (!there) return;
    to.node[slot] = model.carrier[node];
    to.node_feels[slot] = model.feels[node] && through_joint;
  };
  const std::size_t first = n.frame_of[0];
  const bool through = !n.rides || model.feels[i];
  set(0, first - 1, model.has_before(first), through);
  set(1, first, true, through);
  if (n.rides) {
    set(2, first + 1, model.has_after(first), through);
    set(3, i + 1, true, true);
    set(4, i + 2, model.has_after(i + 1), true);
  } else {
    set(2, i + 1, true, true);
    set(3, i + 2, model.has_after(i + 1), true);
  }
  to.angle = n.frame_of;
  to.angle_feels = {through, true};
}

/// From the springs' variables to those of the nodes.
void to_nodes(const Model& model, const Neighbourhood& n, std::size_t i, const Workspace& work,
              const SpringSpace& springs, bool curved, EdgeStiffness& to) {
  const Chain c = chain(model, n, i, work);
  Eigen::Matrix<double, 14, 14> edges = c.to_edges.transpose() * (springs * c.to_edges).eval();
  if (curved) add_tangent_curvature(model, n, i, work, edges);
  to.k.noalias() = c.to_nodes.transpose() * (edges * c.to_nodes).eval();
  place(model, n, i, to);
}

}  // namespace

void edge_stiffness(const Model& model, const NodeRange& rod, std::size_t i, const State& reference,
                    const Workspace& work, EdgeStiffness& to) {
  const Neighbourhood n = neighbourhood(model, rod, i);
  Springs springs;
  for (std::size_t side = 0; side < 2; ++side) add_bending(model, i, side, work, springs);
  const double raw = twist_angle(work.frame[i], work.frame[i + 1]);
  const double tau = reference.twist[i] + std::remainder(raw - reference.twist[i], 2 * M_PI);
  add_twist(model, i, work, tau - model.rest_twist[i], springs);
  if (n.rides) ride(work.frame.z[n.frame_of[0]], work.frame.z[i], springs);
  to_nodes(model, n, i, work, springs.hessian, true, to);
  add_own_edge(
      n, curvature_of_unit(work.e[i], work.length[i], work.g_edge(i)) + stretch_stiffness(model, i, work),
      to);
}

void edge_resistance(const Model& model, const NodeRange& rod, std::size_t i, const Workspace& work,
                     EdgeStiffness& to) {
  const Neighbourhood n = neighbourhood(model, rod, i);
  Springs springs;
  const auto add_rate = [&](double stiffness, const SpringVector& g) {
    springs.hessian += stiffness * g * g.transpose();
  };
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = i + side;
    const int t = kSide[side];
    const Frame f = work.frame[node];
    const EdgeAngles a = edge_angles(work.e[i], f);
    add_rate(model.bend_l[node], along_l(f, a, t, t + 3).gradient / a.cl);
    add_rate(model.bend_m[node], along_m(f, a, t, t + 3).gradient / a.cm);
  }
  const Vec3 ta = work.frame.z[i];
  const Vec3 tb = work.frame.z[i + 1];
  add_rate(model.twist[i], twist_gradient(ta.cross(tb) / (1.0 + ta.dot(tb))));
  if (n.rides) ride(work.frame.z[n.frame_of[0]], work.frame.z[i], springs);
  to_nodes(model, n, i, work, springs.hessian, false, to);
  add_own_edge(n, model.stretch[i] * work.e[i] * work.e[i].transpose(), to);
}

Mat3 stretch_stiffness(const Model& model, std::size_t i, const Workspace& work) {
  const Vec3 e = work.e[i];
  const double tension = model.stretch[i] * (1.0 - model.rest_length[i] * work.inverse_length[i]);
  return (model.stretch[i] - tension) * e * e.transpose() + tension * Mat3::Identity();
}

namespace {

/// Slope and curvature of 1/2 K angle^2 by the cosine z of the angle.
struct ByCosine {
  double slope, curvature;
};
ByCosine by_cosine(double stiffness, double sine, double z) {
  const double angle = std::atan2(sine, z);
  if (sine > 1e-4) {
    const double g = stiffness * angle / sine;
    return {-g, (stiffness - g * z) / (sine * sine)};
  }
  // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5).
  return {-stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle)};
}

/// Of e(d).t by d, for a spring on the cosine between them.
Mat3 by_edge(const ByCosine& w, const Vec3& e, const Vec3& t, double z, double inverse_length) {
  const Vec3 u = inverse_length * (t - z * e);
  const Mat3 bent = inverse_length * inverse_length * z * (Mat3::Identity() - e * e.transpose()) +
                    inverse_length * (e * u.transpose() + u * e.transpose());
  return w.curvature * u * u.transpose() - w.slope * bent;
}

}  // namespace

HingeStiffness hinge_stiffness(const Model& model, std::size_t i, const Workspace& work) {
  const Vec3 a = work.e[i - 1];
  const Vec3 b = work.e[i];
  const double z = a.dot(b);
  const double la = work.inverse_length[i - 1];
  const double lb = work.inverse_length[i];
  const ByCosine w = by_cosine(0.5 * model.bending.hinge[i], a.cross(b).norm(), z);
  const Vec3 u = la * (b - z * a);
  const Vec3 v = lb * (a - z * b);
  // (1 - a a^T)(1 - b b^T) = 1 - a a^T - b b^T + z a b^T
  const Mat3 across = Mat3::Identity() - a * a.transpose() + (z * a - b) * b.transpose();
  return {by_edge(w, a, b, z, la), w.curvature * u * v.transpose() + (w.slope * la * lb) * across,
          by_edge(w, b, a, z, lb)};
}

Mat3 held_hinge_stiffness(const Model& model, std::size_t node, std::size_t i, const Workspace& work) {
  const Vec3 e = work.e[i];
  const Vec3 t = work.frame.z[node];
  const double z = e.dot(t);
  const ByCosine w = by_cosine(model.bend_l[node] + model.bend_t[node], e.cross(t).norm(), z);
  return by_edge(w, e, t, z, work.inverse_length[i]);
}

Eigen::Matrix<double, 3, 9> tangent_by_positions(const Model& model, std::size_t i, const Workspace& work) {
  Eigen::Matrix<double, 3, 9> q = Eigen::Matrix<double, 3, 9>::Zero();
  for (std::size_t side = 0; side < 2; ++side) {
    if (side == 0 ? !model.has_before(i) : !model.has_after(i)) continue;
    const std::size_t edge = i + side - 1;
    const Mat3 by = work.inverse_bisector[i] * work.inverse_length[edge] * projector(work.frame.z[i]) *
                    projector(work.e[edge]);
    q.block<3, 3>(0, static_cast<Eigen::Index>(3 * side)) -= by;
    q.block<3, 3>(0, static_cast<Eigen::Index>(3 * side + 3)) += by;
  }
  return q;
}

}  // namespace tendril
