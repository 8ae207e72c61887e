#pragma once

#include <array>

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

/// Turns the derivatives by the nodes' own tangents and angles into those by what moves their frames: the
/// frame of another node that the first is fixed to, the turn of a swivel in the place of its angle.
/// \param frame_of  the nodes whose frames those of edge i are, or are fixed to
void by_frames(const Model& model, const std::array<std::size_t, 2>& frame_of, std::size_t i,
               const Kinematics& kin, SpringStiffness& s);

Mat3 cross_matrix(const Vec3& v);

}  // namespace tendril
