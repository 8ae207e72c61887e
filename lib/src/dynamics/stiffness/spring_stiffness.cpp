#include "spring_stiffness.h"

#include <cmath>
#include <utility>

#include "dynamics/rhs/held.h"
#include "dynamics/vector/lanes.h"
#include "edge_stiffness.h"

namespace tendril {
namespace {

/// Adds W(x, y, z) of the components e.l, e.m and e.t at node `side`, by its gradient and Hessian:
/// J W'' J^T and what the components' own second derivatives add. By e alone they have none. The frame
/// carried by the smallest rotation to t = t_s + d, then turned by theta, is to second order, with a = d.l
/// and b = d.m,
///
///   l -> l - a t + theta m - a d / 2 - theta^2 l / 2 - theta b t
///   m -> m - b t - theta l - b d / 2 - theta^2 m / 2 + theta a t
void add_all(const Frame& f, const Vec3& e, const EdgeAngles& at, std::size_t side, const Vec3& slope,
             const Mat3& curvature, SpringStiffness& s) {
  Mat3 by_e, by_t;
  by_e << f.x, f.y, f.z;
  by_t << -at.z * f.x, -at.z * f.y, e;
  const Vec3 by_theta(at.y, -at.x, 0.0);
  const Vec3 across = slope[0] * f.x + slope[1] * f.y;
  const Vec3 turned = slope[0] * f.y - slope[1] * f.x;
  s.g_e += by_e * slope;
  s.g_t[side] += by_t * slope;
  if (side == 0) s.g_theta += by_theta.dot(slope);

  const Mat3 we = by_e * curvature;
  const Mat3 wt = by_t * curvature;
  s.ee += we * by_e.transpose();
  s.et[side] += we * by_t.transpose() - f.z * across.transpose() + slope[2] * Mat3::Identity();
  const Mat3 lm = f.x * f.y.transpose();
  s.tt[side] += wt * by_t.transpose() - (slope[0] * at.x) * f.x * f.x.transpose() -
                (slope[1] * at.y) * f.y * f.y.transpose() -
                (0.5 * (slope[0] * at.y + slope[1] * at.x)) * (lm + lm.transpose());
  s.e_theta[side] += we * by_theta + turned;
  s.t_theta[side][side] += wt * by_theta - at.z * turned;
  s.theta[side] += by_theta.dot(curvature * by_theta) - slope[0] * at.x - slope[1] * at.y;
}

/// Adds W(z) of the component z = e.t at node `side`.
void add_along(const Vec3& e, const Vec3& t, std::size_t side, double slope, double curvature,
               SpringStiffness& s) {
  s.g_e += slope * t;
  s.g_t[side] += slope * e;
  s.ee += curvature * t * t.transpose();
  s.et[side] += curvature * t * e.transpose() + slope * Mat3::Identity();
  s.tt[side] += curvature * e * e.transpose();
}

/// -(z + 3/2 rise) / w at w = st^2, the rise's own derivative by w: 4/5 + 2/7 w + ... on the near side.
double rise_by_square(const EdgeAngles& at) {
  const double w = at.st * at.st;
  if (!(w <= lanes::kNearSquare && at.z > 0.0)) return -(at.z + 1.5 * at.rise) / w;
  return lanes::horner(w, 0.8, 2.0 / 7, 1.0 / 6, 5.0 / 44, 35.0 / 416, 0.065625, 0.05307904411764706,
                       0.044099506578947366, 0.03740583147321429, 0.032255753226902176);
}

/// One deviation, r x of the component x, with r = phi / sin(phi) of phi = atan2(sqrt(x^2 + y^2), z).
struct Deviation {
  Vec3 slope;  ///< by x, y, z
  Mat3 curvature;
};
Deviation deviation(double x, double y, double z, double ratio, double rise, double rise_by_w) {
  const double xx = x * x;
  const double by_w = 2 * rise_by_w;
  Deviation d;
  d.slope = {ratio + rise * xx, rise * x * y, -x};
  const double xy = rise * y + by_w * xx * y;
  const double yz = 2 * x * y;
  const double xz = 2 * xx - 1.0;
  d.curvature << 3 * rise * x + by_w * xx * x, xy, xz, xy, x * (rise + by_w * y * y), yz, xz, yz, 2 * x * z;
  return d;
}

struct Deviations {
  Deviation l, m;
};
Deviations deviations(const EdgeAngles& at) {
  const double by_w = rise_by_square(at);
  Deviations d{deviation(at.x, at.y, at.z, at.ratio, at.rise, by_w),
               deviation(at.y, at.x, at.z, at.ratio, at.rise, by_w)};
  std::swap(d.m.slope[0], d.m.slope[1]);
  d.m.curvature.row(0).swap(d.m.curvature.row(1));
  d.m.curvature.col(0).swap(d.m.curvature.col(1));
  return d;
}

/// 1/2 K (acos(e.t) - rest)^2.
void add_third(const Vec3& e, const Vec3& t, std::size_t side, double stiffness, double angle, double rest,
               double sine, double z, SpringStiffness& s) {
  if (sine > 1e-4) {
    const double g = stiffness * (angle - rest) / sine;
    add_along(e, t, side, -g, (stiffness - g * z) / (sine * sine), s);
  } else if (rest == 0.0) {
    // angle / sine = 1 + angle^2 / 6 + ..., so the curvature tends to K / 3 (1 + 2 angle^2 / 5).
    add_along(e, t, side, -stiffness * (1.0 + angle * angle / 6), stiffness / 3 * (1.0 + 0.4 * angle * angle),
              s);
  }
}

void add_bending(const Model& model, std::size_t i, std::size_t side, double viscosity, const Kinematics& kin,
                 const Gradient& grad, SpringStiffness& s) {
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
  const Deviations by = deviations(a);
  const double kl = model.bend_l[node];
  const double km = model.bend_m[node];
  const Vec3 way = side == 0 ? Vec3(grad.given[node]) : Vec3(Vec3::Zero());
  const double fl = kl * l - (kl + model.bend_t[node]) * way.x();
  const double fm = km * m - (km + model.bend_t[node]) * way.y();
  add_all(f, e, a, side, fl * by.l.slope + fm * by.m.slope,
          kl * by.l.slope * by.l.slope.transpose() + km * by.m.slope * by.m.slope.transpose() +
              fl * by.l.curvature + fm * by.m.curvature,
          s);
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
                                 const Kinematics& kin, const Gradient& grad, bool viscous) {
  SpringStiffness s;
  const double viscosity = viscous ? model.viscosity[i] : 0.0;
  for (std::size_t side = 0; side < 2; ++side) add_bending(model, i, side, viscosity, kin, grad, s);
  double strain = twist_strain(model, reference, i, kin) - grad.given[i].z();
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
    const Deviations by = deviations(a);
    add_all(f, kin.e[i], a, side, Vec3::Zero(),
            model.bend_l[node] * by.l.slope * by.l.slope.transpose() +
                model.bend_m[node] * by.m.slope * by.m.slope.transpose(),
            s);
  }
  const Vec3 ta = kin.frame.z[i];
  const Vec3 tb = kin.frame.z[i + 1];
  add_twist_gradient(model.twist[i], ta.cross(tb) / (1.0 + ta.dot(tb)), s);
  return s;
}

void by_parent_frame(const Vec3& t, const Vec3& t0, SpringStiffness& s) {
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
