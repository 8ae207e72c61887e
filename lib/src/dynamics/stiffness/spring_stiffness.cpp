#include "spring_stiffness.h"

#include <cmath>

namespace tendril {
namespace {

Mat3 projector(const Vec3& n) {
  return Mat3::Identity() - n * n.transpose();
}

/// First and second derivatives of one of the components e.l, e.m, e.t by e, t and theta of one node. By e
/// alone they have no second derivative.
struct Component {
  Vec3 e, t;
  double theta;
  Mat3 et, tt;
  Vec3 e_theta, t_theta;
  double theta_theta;
};

/// The frame carried by the smallest rotation to t = t_s + d, then turned by theta, to second order, with
/// a = d.l, b = d.m:
///
///   l -> l - a t + theta m - a d / 2 - theta^2 l / 2 - theta b t
///   m -> m - b t - theta l - b d / 2 - theta^2 m / 2 + theta a t
Component along_l(const Frame& f, const EdgeAngles& at) {
  return {f.x,
          -at.z * f.x,
          at.y,
          -f.z * f.x.transpose(),
          -at.x * f.x * f.x.transpose() - 0.5 * at.y * (f.x * f.y.transpose() + f.y * f.x.transpose()),
          f.y,
          -at.z * f.y,
          -at.x};
}

Component along_m(const Frame& f, const EdgeAngles& at) {
  return {f.y,
          -at.z * f.y,
          -at.x,
          -f.z * f.y.transpose(),
          -at.y * f.y * f.y.transpose() - 0.5 * at.x * (f.x * f.y.transpose() + f.y * f.x.transpose()),
          -f.x,
          at.z * f.x,
          -at.y};
}

/// Adds the spring W(q) with q one of the components at node `side`: W'' grad grad^T + W' hess.
void add(const Component& q, std::size_t side, double slope, double curvature, SpringStiffness& s) {
  s.g_e += slope * q.e;
  s.g_t[side] += slope * q.t;
  if (side == 0) s.g_theta += slope * q.theta;
  const Vec3 e = curvature * q.e;
  const Vec3 t = curvature * q.t;
  s.ee += e * q.e.transpose();
  s.et[side] += e * q.t.transpose() + slope * q.et;
  s.tt[side] += t * q.t.transpose() + slope * q.tt;
  s.e_theta[side] += q.theta * e + slope * q.e_theta;
  s.t_theta[side][side] += q.theta * t + slope * q.t_theta;
  s.theta[side] += curvature * q.theta * q.theta + slope * q.theta_theta;
}

/// 1/2 K (asin(q) - rest)^2; `cosine` that of the angle.
void add_deviation(const Component& q, std::size_t side, double stiffness, double strain, double sine,
                   double cosine, SpringStiffness& s) {
  const double slope = stiffness * strain / cosine;
  add(q, side, slope, (stiffness + slope * sine) / (cosine * cosine), s);
}

/// 1/2 K (acos(e.t) - rest)^2.
void add_third(const Vec3& e, const Vec3& t, std::size_t side, double stiffness, double angle, double rest,
               double sine, double z, SpringStiffness& s) {
  const Component q{t, e, 0.0, Mat3::Identity(), Mat3::Zero(), Vec3::Zero(), Vec3::Zero(), 0.0};
  if (sine > 1e-4) {
    const double g = stiffness * (angle - rest) / sine;
    add(q, side, -g, (stiffness - g * z) / (sine * sine), s);
  } else if (rest == 0.0) {
    // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5).
    add(q, side, -stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle), s);
  }
}

/// How fast the two deviations at a side change; `spin` of its node.
struct DeviationRates {
  double l, m;
};
DeviationRates deviation_rates(const Frame& f, const EdgeAngles& at, const Vec3& e_rate, const Vec3& t_rate,
                               double spin) {
  return {(e_rate.dot(f.x) - f.x.dot(t_rate) * at.z + spin * at.y) / at.cl,
          (e_rate.dot(f.y) - f.y.dot(t_rate) * at.z - spin * at.x) / at.cm};
}

void add_bending(const Model& model, std::size_t i, std::size_t side, double viscosity, const Kinematics& kin,
                 SpringStiffness& s) {
  const std::size_t node = i + side;
  const std::size_t end = 2 * i + side;
  const Vec3 e = kin.e[i];
  const Frame f = kin.frame[node];
  const EdgeAngles a = edge_angles(e, f);
  double l = a.l - model.rest_l[end];
  double m = a.m - model.rest_m[end];
  if (viscosity > 0.0) {
    const DeviationRates rate = deviation_rates(f, a, kin.rate.e_rate[i], kin.t_rate(node), kin.spin[node]);
    l += viscosity * rate.l;
    m += viscosity * rate.m;
  }
  add_deviation(along_l(f, a), side, model.bend_l[node], l, a.x, a.cl, s);
  add_deviation(along_m(f, a), side, model.bend_m[node], m, a.y, a.cm, s);
  if (model.bend_t[node] > 0.0)
    add_third(e, f.z, side, model.bend_t[node], a.t, model.rest_t[end], a.st, a.z, s);
}

/// K grad tau grad tau^T with grad tau = (c, -1) at the first node, (c, 1) at the second.
void add_twist_gradient(double stiffness, const Vec3& c, SpringStiffness& s) {
  const Mat3 outer = stiffness * c * c.transpose();
  const Vec3 mixed = stiffness * c;
  s.tt[0] += outer;
  s.tt[1] += outer;
  s.t0_t1 += outer;
  for (auto& by : s.t_theta) {
    by[0] -= mixed;
    by[1] += mixed;
  }
  s.theta[0] += stiffness;
  s.theta[1] += stiffness;
  s.theta0_theta1 -= stiffness;
}

/// tau = theta_b - theta_a + a function of the tangents, whose gradient away from the reference is
/// c + (t_s x t) / (1 + t_s.t) at a and c minus the like at b, c = (t_a x t_b) / (1 + t_a.t_b).
void add_twist(const Model& model, std::size_t i, const Kinematics& kin, double strain, SpringStiffness& s) {
  const Vec3 ta = kin.frame.z[i];
  const Vec3 tb = kin.frame.z[i + 1];
  const double k = 1.0 + ta.dot(tb);
  const Vec3 c = ta.cross(tb) / k;
  const double torque = model.twist[i] * strain;
  for (Vec3& g : s.g_t) g += torque * c;
  s.g_theta -= torque;
  add_twist_gradient(model.twist[i], c, s);
  const Mat3 by_a = -(cross_matrix(tb) + c * tb.transpose()) / k;
  const Mat3 by_b = (cross_matrix(ta) - c * ta.transpose()) / k;
  const Mat3 pa = projector(ta);
  const Mat3 pb = projector(tb);
  const auto symmetric = [](const Mat3& m) { return Mat3(0.5 * (m + m.transpose())); };
  s.tt[0] += torque * symmetric(pa * (by_a + 0.5 * cross_matrix(ta)) * pa);
  s.tt[1] += torque * symmetric(pb * (by_b - 0.5 * cross_matrix(tb)) * pb);
  s.t0_t1 += torque * (pa * by_b * pb);
}

}  // namespace

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Mat3 curvature_of_unit(const Vec3& n, double inverse_length, const Vec3& g) {
  const Vec3 across = g - g.dot(n) * n;
  return -(inverse_length * inverse_length) *
         (g.dot(n) * projector(n) + n * across.transpose() + across * n.transpose());
}

SpringStiffness spring_stiffness(const Model& model, std::size_t i, const State& reference,
                                 const Kinematics& kin, bool viscous) {
  SpringStiffness s;
  const double viscosity = viscous ? model.viscosity[i] : 0.0;
  for (std::size_t side = 0; side < 2; ++side) add_bending(model, i, side, viscosity, kin, s);
  const double raw = twist_angle(kin.frame[i], kin.frame[i + 1]);
  const double tau = reference.twist[i] + std::remainder(raw - reference.twist[i], 2 * M_PI);
  double strain = tau - model.rest_twist[i];
  if (viscosity > 0.0) {
    const Vec3 ta = kin.frame.z[i];
    const Vec3 tb = kin.frame.z[i + 1];
    const Vec3 turning = kin.t_rate(i) + kin.t_rate(i + 1);
    strain += viscosity * (kin.spin[i + 1] - kin.spin[i] + ta.cross(tb).dot(turning) / (1.0 + ta.dot(tb)));
  }
  add_twist(model, i, kin, strain, s);
  return s;
}

SpringStiffness spring_resistance(const Model& model, std::size_t i, const Kinematics& kin) {
  SpringStiffness s;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t node = i + side;
    const Frame f = kin.frame[node];
    const EdgeAngles a = edge_angles(kin.e[i], f);
    add(along_l(f, a), side, 0.0, model.bend_l[node] / (a.cl * a.cl), s);
    add(along_m(f, a), side, 0.0, model.bend_m[node] / (a.cm * a.cm), s);
  }
  const Vec3 ta = kin.frame.z[i];
  const Vec3 tb = kin.frame.z[i + 1];
  add_twist_gradient(model.twist[i], ta.cross(tb) / (1.0 + ta.dot(tb)), s);
  return s;
}

void ride(const Vec3& t, const Vec3& t0, SpringStiffness& s) {
  const Vec3 g = s.g_t[0];
  const double g_theta = s.g_theta;
  Eigen::Matrix4d first;
  first << t0.dot(t) * Mat3::Identity() - t * t0.transpose(), t.cross(t0), t0.cross(t).transpose(), t0.dot(t);

  // e, t_1 and theta_1 by (t_0, theta_0).
  Eigen::Matrix<double, 7, 4> beside;
  beside << s.et[0], s.e_theta[0], s.t0_t1.transpose(), s.t_theta[1][0], s.t_theta[0][1].transpose(),
      s.theta0_theta1;
  beside = (beside * first).eval();
  s.et[0] = beside.block<3, 3>(0, 0);
  s.e_theta[0] = beside.block<3, 1>(0, 3);
  s.t0_t1 = beside.block<3, 3>(3, 0).transpose();
  s.t_theta[1][0] = beside.block<3, 1>(3, 3);
  s.t_theta[0][1] = beside.block<1, 3>(6, 0).transpose();
  s.theta0_theta1 = beside(6, 3);

  Eigen::Matrix4d own;
  own << s.tt[0], s.t_theta[0][0], s.t_theta[0][0].transpose(), s.theta[0];
  Eigen::Matrix<double, 3, 4> phi;
  phi << cross_matrix(t), t;
  const Mat3 outer = 0.5 * (g * t0.transpose() + t0 * g.transpose()) - g.dot(t0) * Mat3::Identity();
  own = (first.transpose() * own * first + phi.transpose() * outer * phi).eval();
  s.tt[0] = own.topLeftCorner<3, 3>();
  s.t_theta[0][0] = own.block<3, 1>(0, 3) + 0.5 * projector(t) * (t0.cross(g) + g_theta * t0);
  s.theta[0] = own(3, 3);
}

}  // namespace tendril
