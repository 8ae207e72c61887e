#pragma once

#include "dynamics/rhs/workspace.h"

namespace tendril {

/// Derivatives of what a turning tangent does at a free node with twist, by the vectors d along its two edges
/// (0 before, 1 after; 0 where there is none), at a state that is its own reference. With t(d) the tangent,
/// R_k = dt/dd_k, I w the spin's momentum and g_s the springs' gradient by the spin:
///
/// - the gyroscopic force on d_k, R_k^T I w (t x t'), by positions, velocities and spin;
/// - the difference between the Hessian of E(p, theta), whose directors are carried along, and the derivative
///   of the forces, which are its gradient with directors that do not spin: -1/2 g_s R_k^T (t x R_j),
///   antisymmetric;
/// - the connection term ((t_s x t).t') / (1 + t_s.t), which changes by 1/2 (t' x t).dt.
struct TurningTerms {
  Mat3 by_x[2][2], by_v[2][2];  ///< force on d_k by d_j, d_j'
  Vec3 by_spin[2];              ///< force on d_k by w
  Vec3 connection[2];           ///< theta' by d_k
};

/// Needs kinematics with all rates.
TurningTerms turning_terms(const Model& model, std::size_t i, double g_spin, const Kinematics& kin);

}  // namespace tendril
