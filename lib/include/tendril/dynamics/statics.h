#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/statics_options.h>
#include <tendril/dynamics/system.h>

#include <string>

namespace tendril {

/// Why the search ended. Only `converged` is success: the residual is at most 1e-9, in every direction. After
/// any other the state is the last equilibrium found before.
enum class Balance {
  converged,      ///< at the last load and time
  stalled,        ///< no step of the loads or the time is short enough, or rounding hides the tolerance
  unheld,         ///< a load acts along a direction that nothing resists
  work_limit,     ///< StaticsOptions::work_limit was reached
  not_evaluable,  ///< zero-length edge, fold-back or a number that is not finite where the search leads
  cancelled,      ///< StaticsOptions::progress asked for it
};
/// The enumerator's name.
TENDRIL_CORE_API const char* to_string(Balance balance);

/// Stability of an equilibrium by the eigenvalues mu of its tangent stiffness, K x = mu D x. D is diagonal:
/// the share of each node in the length l (over l^2 for positions, as it is for angles), so that mu is an
/// energy, 12.36 B / l for the straight cantilever. An eigenvalue counts as 0 within a threshold: the largest
/// of 1e-8 B / l, the rounding of K and, of an equilibrium that was found, a bound on the sum of its
/// unbalanced forces, times l. Loads without an energy can shake a rod that K holds: with them nothing is
/// judged, and all counts are 0.
struct Stability {
  /// By the smallest eigenvalue.
  enum class Kind {
    stable,     ///< above the threshold
    neutral,    ///< within it
    unstable,   ///< below minus the threshold
    not_judged  ///< some load has no energy, or a joint does not react
  };
  Kind kind = Kind::neutral;  ///< by the smallest eigenvalue
  int unstable = 0;           ///< eigenvalues below -threshold
  int neutral = 0;            ///< eigenvalues within the threshold
  double smallest = 0.0;      ///< the smallest eigenvalue [energy]
  double threshold = 0.0;     ///< [energy]
};
/// The enumerator's name.
TENDRIL_CORE_API const char* to_string(Stability::Kind kind);

/// What find_equilibrium finds.
struct Equilibrium {
  State state;                           ///< at rest, its frames renewed, twists unwrapped
  Balance balance = Balance::converged;  ///< why the search ended
  std::string reason;        ///< one sentence with load, time, rod, node and numbers; empty when converged
  double load = 0.0;         ///< share reached
  Stability stability;       ///< of the state
  bool conservative = true;  ///< all loads have an energy (at a fixed time) and all joints react
  double residual = 0.0;     ///< largest unbalanced force, or torque over l, relative to `force_scale`
  /// The largest of the loads' sum, a held node's reaction, B / l^2 and, in very stiff rods, 2e9 times what
  /// half a unit in the last place of the positions makes of a force: balance cannot be told any closer.
  double force_scale = 0.0;
  double last_step = 0.0;     ///< what `tolerance` was compared with
  double elastic = 0.0;       ///< energy
  double potential = 0.0;     ///< of the loads that have one, at their last factor
  std::vector<Vec3> support;  ///< per anchor, the force it puts on its node; 0 where it holds no position
  std::vector<Vec3> torque;   ///< likewise on its frame, about the node; 0 where it holds no frame
  long steps = 0;             ///< of load or time
  long iterations = 0;        ///< of Newton's method
  long factorisations = 0;    ///< of the tangent
  int left = 0;               ///< unstable branches left before this state
};

/// Equilibrium of a scene: Newton's method on positions and directors with the exact Hessian of the elastic
/// energy (loads that depend on the state by differences), followed from `start` as loads or anchors change
/// in steps whose predicted turns are small. Each step turns edges rather than shears them, and is watched by
/// the energy, or where a load has none by the unbalanced forces. An indefinite tangent is shifted until it
/// goes downhill (`stable`), and an unstable equilibrium is left along its lowest mode, the sign chosen by
/// the energy and else always the same. Where nothing resists a load it is followed to where something does,
/// as a hinged bar falls until it hangs. Deterministic. Cost: O(nodes) a factorisation on chains and trees.
///
/// The condition of a fine clamped rod grows with the fourth power of its edges: beyond some thousands
/// rounding hides small tolerances, and the result says so.
///
/// Throws InvalidInput for options out of range.
/// \param system   not kept
/// \param start    anything near the first equilibrium, as rest_state(time); velocities are put to 0
/// \param options  see there
TENDRIL_CORE_API Equilibrium find_equilibrium(const System& system, State start,
                                              const StaticsOptions& options = {});

/// Stability of a state as it is, an equilibrium or not, with all loads times `load`.
TENDRIL_CORE_API Stability stability_of(const System& system, const State& state, double load = 1.0);

}  // namespace tendril
