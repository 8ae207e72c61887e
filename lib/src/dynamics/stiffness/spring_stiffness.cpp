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

namespace {

/// Turns the derivatives by the first node's own (t_0, theta_0) into those by (t, theta) of a frame it is
/// fixed to. With d = t' - t that frame turns by phi = t x d + theta t + theta d / 2, which takes t_0 by
/// phi x t_0 + phi x (phi x t_0) / 2 and theta_0 by phi . t_0, all to second order.
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

/// Turns the derivatives by (t, theta) of the frame at a side into those by its turn about an axis a, in the
/// place of theta: t goes by a x t and a x (a x t) / 2, theta by a . t, to second order.
/// \param g  slope by that frame's t
void by_swivel(const Vec3& a, const Vec3& t, const Vec3& g, std::size_t side, SpringStiffness& s) {
  const std::size_t other = 1 - side;
  const Vec3 d = a.cross(t);
  const double along = a.dot(t);
  const Vec3 other_t = side == 0 ? Vec3(s.t0_t1.transpose() * d) : Vec3(s.t0_t1 * d);
  s.e_theta[side] = s.et[side] * d + along * s.e_theta[side];
  s.t_theta[other][side] = other_t + along * s.t_theta[other][side];
  s.theta0_theta1 = d.dot(s.t_theta[side][other]) + along * s.theta0_theta1;
  s.theta[side] = d.dot(s.tt[side] * d) + 2.0 * along * d.dot(s.t_theta[side][side]) +
                  along * along * s.theta[side] + g.dot(along * a - t);
  s.et[side].setZero();
  s.tt[side].setZero();
  s.t0_t1.setZero();
  for (Vec3& by : s.t_theta[side]) by.setZero();
}

}  // namespace

void by_frames(const Model& model, const std::array<std::size_t, 2>& frame_of, std::size_t i,
               const Kinematics& kin, SpringStiffness& s) {
  Vec3 g[2] = {s.g_t[0], s.g_t[1]};
  if (frame_of[0] != i) {
    const Vec3 t = kin.frame.z[frame_of[0]];
    const Vec3 t0 = kin.frame.z[i];
    g[0] = (t0.cross(s.g_t[0]) + s.g_theta * t0).cross(t);
    by_parent_frame(t, t0, s);
  }
  for (std::size_t side = 0; side < 2 && !model.swivels.empty(); ++side)
    if (const Model::Swivel* swivel = model.swivel_of(frame_of[side])) {
      const Frame frame = kin.frame[frame_of[side]];
      by_swivel(swivel->of(frame), frame.z, g[side], side, s);
    }
}

}  // namespace tendril
