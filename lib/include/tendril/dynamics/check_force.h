#pragma once

#include <tendril/dynamics/force.h>

namespace tendril {

/// How a force keeps to what it says of itself, at one state. For tests of forces.
struct ForceCheck {
  /// Pairs (i, j) that its couplings do not name, or not at this state, although the load on node i changes
  /// when the state of node j is moved, by a single bit: an honest force has none.
  std::vector<Couplings::Pair> undeclared;
  /// Largest error of the exact derivatives against central differences, over the largest derivative: some
  /// 1e-9 where they are right and the loads smooth. 0 where none are given.
  double derivatives = 0.0;
  /// Largest error of force = -dE/dp, and of torque as -dE by a turn of the node's frame or the body, against
  /// central differences, over the largest load. 0 without an energy.
  double energy = 0.0;
  /// Largest difference between its loads and those that LocalCouplings::add gives, at this state and those
  /// beside it, over the largest load. 0 where there is none such.
  double local = 0.0;
  /// False when it says that it leaves frames alone (Force::acts_on_frames), and adds a torque on a node, or
  /// another load as a frame turns.
  bool frames = true;
};

/// Moves the state of each node and body a little and compares. Pairs count as in Force::couplings; torques
/// on bodies count as forces at the longest edge, turns of bodies as ways there.
/// \param force  the force to check
/// \param state  any at which the force acts, with distinct neighbours; copied
/// \param step   of the differences, over the longest edge (the length unit without rods), the largest speed
///               (at least one edge a time unit) or 1 rad
/// About 20 calls of add() a node, 30 a body.
TENDRIL_CORE_API ForceCheck check_force(const Force& force, const StateView& state, double step = 1e-5);

}  // namespace tendril
