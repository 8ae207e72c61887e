#include "spring_stiffness.h"

#include "edge_stiffness.h"
#include "springs.h"

namespace tendril {
namespace {

Vec3 vector(const lanes::V3& a) {
  return {a.x, a.y, a.z};
}
Mat3 matrix(const lanes::Matrix<double>& a) {
  Mat3 m;
  m << vector(a.c[0]), vector(a.c[1]), vector(a.c[2]);
  return m;
}

SpringStiffness as_matrices(const lanes::Springs<double>& s) {
  SpringStiffness to;
  to.g_e = vector(s.g_e);
  to.g_theta = s.g_theta;
  to.ee = matrix(s.ee);
  to.t0_t1 = matrix(s.t0_t1);
  to.theta0_theta1 = s.theta0_theta1;
  for (const std::size_t side : {0, 1}) {
    to.g_t[side] = vector(s.g_t[side]);
    to.et[side] = matrix(s.et[side]);
    to.tt[side] = matrix(s.tt[side]);
    to.e_theta[side] = vector(s.e_theta[side]);
    for (const std::size_t by : {0, 1}) to.t_theta[side][by] = vector(s.t_theta[side][by]);
    to.theta[side] = s.theta[side];
  }
  return to;
}

}  // namespace

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

lanes::Direction<double> lanes::any_direction(double x, double y, double z) {
  Direction<double> d{x, y, z, {}, {}, {}};
  const double w = x * x + y * y;
  if (all_near(w, z)) {
    fill_near(w, d);
    return d;
  }
  const EdgeAngles at = edge_angles({x, y, z}, Frame{});
  d.ratio = at.ratio;
  d.rise = at.rise;
  d.rise_by_square = -(z + 1.5 * at.rise) / w;
  return d;
}

SpringStiffness spring_stiffness(const Model& model, std::size_t i, const Kinematics& kin,
                                 const Gradient& grad, bool viscous) {
  return as_matrices(lanes::springs_of<double>(model, i, viscous, kin, grad));
}

SpringStiffness spring_resistance(const Model& model, std::size_t i, const Kinematics& kin) {
  return as_matrices(lanes::resistance_of<double>(model, i, kin));
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
