#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/fit.h>

#include <vector>

namespace tendril {

/// Forces on the control points of a curve-pair: its virtual work under moves du, dv of the control points is
/// sum primary_i . du_i + orientation_i . dv_i.
struct ControlForces {
  std::vector<Vec3> primary;      ///< per control point, world vectors [force]
  std::vector<Vec3> orientation;  ///< the same number
};

/// Forces and torques on point masses, world vectors: their virtual work under moves dp and turns phi of the
/// node frames is sum force_i . dp_i + torque_i . phi_i.
struct MassLoads {
  std::vector<Vec3> force;   ///< per mass [force]
  std::vector<Vec3> torque;  ///< the same number [torque]
};

/// What forces on the control points mean for the masses p_i that both curves interpolate, whose orientation
/// masses q_i = p_i + arm_i move with the node frames (dq_i = dp_i + phi_i x arm_i): with N the matrix of the
/// interpolation, force = N^-T (primary + orientation) and torque_i = arm_i x (N^-T orientation)_i. The
/// resultant force and torque stay the same. O(n).
/// \param fit     of the rod, as the curves were made by it
/// \param forces  as many as the curves have control points, else InvalidInput
/// \param arm     q_i - p_i, the same number, else InvalidInput
TENDRIL_CORE_API MassLoads loads_on_masses(const Interpolator& fit, const ControlForces& forces, Points arm);

}  // namespace tendril
