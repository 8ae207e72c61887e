#pragma once

#include "dynamics/rhs/workspace.h"
#include "dynamics/vector/block.h"

namespace tendril {

/// Derivatives of what turning tangents do at neighbouring nodes with twist, at a state that is its own
/// reference. By the vectors d along a node's two edges (0 before, 1 after; 0 where there is none), with t(d)
/// the tangent, R_k = dt/dd_k, I w the spin's momentum and g_s the springs' gradient by the spin:
///
/// - the gyroscopic force on d_k, R_k^T I w (t x t'), by positions, velocities and spin;
/// - the difference between the Hessian of E(p, theta), whose directors are carried along, and the derivative
///   of the forces, which are its gradient with directors that do not spin: -1/2 g_s R_k^T (t x R_j),
///   antisymmetric;
/// - the connection term ((t_s x t).t') / (1 + t_s.t), which changes by 1/2 (t' x t).dt.
///
/// Of node i all that by the nodes i - 1, i, i + 1: nine blocks, rows by columns.
struct TurningPack {
  static constexpr std::size_t kNodes = 4, kSlots = 3, kBlocks = kSlots * kSlots;
  std::array<Block<4>, kNodes * kBlocks> by_x,
      by_v;                              ///< forces; by velocities and, in the fourth column, spin
  double connection[kNodes][kSlots][4];  ///< theta' by three positions
};

/// Of `count` nodes from i on, one or kNodes. Needs kinematics with all rates and the springs' gradient.
void turning_terms(const Model& model, std::size_t i, std::size_t count, const Kinematics& kin,
                   const Gradient& grad, TurningPack& to);

/// Where block k of node i's nine stands. Nothing turns at a held frame.
BlockPlace place_of_turning(const Model& model, std::size_t i, std::size_t k);

}  // namespace tendril
