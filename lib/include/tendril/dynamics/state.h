#pragma once

#include <tendril/base/types.h>

#include <vector>

namespace tendril {

/// The state of all rods: the integrated numbers y, and the frames they are measured against.
///
/// y = (p 3n | v 3n | theta m | w m | work 1), n nodes, m of them with twist (all of a rod or none). theta_i
/// is the angle of the director against `director[i]` carried from `tangent[i]` to the tangent by the
/// smallest rotation; w_i the spin about the tangent; work that done so far by forces without an energy, by
/// damping and by moving anchors.
///
/// Of a rod without twist state only one node's reference is kept (the last with a held frame, or the first):
/// the others' directors follow it along the rod. System::frames has them all.
struct State {
  double time = 0.0;
  Eigen::VectorXd y;
  std::vector<Vec3> tangent, director;  ///< reference frames, renewed after every accepted step
  std::vector<double> twist;            ///< unwrapped twist of each edge at the reference
};

/// Whether the equations could be evaluated, and if not, why and where.
struct Evaluation {
  enum class Outcome {
    ok,
    zero_edge,
    fold_back,
    turned_too_far,
    not_finite,
    not_converged  ///< an implicit step's equations
  } outcome = Outcome::ok;
  std::size_t node = 0;  ///< flat index
  bool ok() const { return outcome == Outcome::ok; }
};

/// Energies in the scene's units. total() + work taken out is constant up to the integration error.
struct Energies {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;
  double total() const { return kinetic + elastic + potential; }
};

}  // namespace tendril
