#pragma once

#include "dynamics/rhs/workspace.h"

namespace tendril {

/// Derivatives of one edge's bending and twist springs by what they see, as lanes::Springs (springs.h) has
/// them.
struct SpringStiffness {
  // Slopes: by e, by t of either node, and by theta of the first.
  Vec3 g_e = Vec3::Zero();
  Vec3 g_t[2] = {Vec3::Zero(), Vec3::Zero()};
  double g_theta = 0.0;

  Mat3 ee = Mat3::Zero();
  Mat3 et[2] = {Mat3::Zero(), Mat3::Zero()};       ///< e by t of either node
  Mat3 tt[2] = {Mat3::Zero(), Mat3::Zero()};       ///< t by the same t
  Mat3 t0_t1 = Mat3::Zero();                       ///< t of the first node by t of the second
  Vec3 e_theta[2] = {Vec3::Zero(), Vec3::Zero()};  ///< e by theta of either node
  Vec3 t_theta[2][2] = {{Vec3::Zero(), Vec3::Zero()}, {Vec3::Zero(), Vec3::Zero()}};  ///< t by theta
  double theta[2] = {0.0, 0.0};
  double theta0_theta1 = 0.0;
};

/// Second derivatives of the energy of edge i: lanes::springs_of.
SpringStiffness spring_stiffness(const Model& model, std::size_t i, const Kinematics& kin,
                                 const Gradient& grad, bool viscous);

/// sum k grad q grad q^T over the two deviations at either end and the twist of edge i.
SpringStiffness spring_resistance(const Model& model, std::size_t i, const Kinematics& kin);

/// Turns the derivatives by the first node's own (t_0, theta_0) into those by (t, theta) of a frame it is
/// fixed to. With d = t' - t that frame turns by phi = t x d + theta t + theta d / 2, which takes t_0 by
/// phi x t_0 + phi x (phi x t_0) / 2 and theta_0 by phi . t_0, all to second order.
void by_parent_frame(const Vec3& t, const Vec3& t0, SpringStiffness& s);

Mat3 cross_matrix(const Vec3& v);

}  // namespace tendril
