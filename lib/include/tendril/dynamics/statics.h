#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/system.h>

#include <functional>
#include <optional>
#include <string>

namespace tendril {

/// How an equilibrium is searched for. Lengths compare with the longest rod's length l at rest.
struct StaticsOptions {
  /// Which equilibrium is followed.
  enum class Seek {
    stable,  ///< down the energy, off every branch that has become unstable
    nearest  ///< along the branch, stable or not
  };
  Seek seek = Seek::stable;  ///< which one

  double first_load = 0.0;  ///< factor on all loads at the start
  double last_load = 1.0;   ///< the factor they grow to, at the start's time
  /// Then anchors and forces are followed in time until then (default: not at all).
  std::optional<double> until = {};

  /// Of the last Newton step: its largest position over l or angle, or, less along soft directions, the root
  /// of the energy it gains over B / l (the bending stiffness of the softest rod, over its length). Where
  /// steps no longer shrink and gain less than the rounding of the energy (1e-13 of its parts), the search
  /// ends too: see Equilibrium::last_step.
  double tolerance = 1e-9;
  double largest_step = 1.0;  ///< share of the loads' range, and of the time's, in one step: 0 to 1
  long work_limit = 20'000;   ///< factorisations of the tangent
  /// Called after every step with the share of the whole done, 0 to 1; false cancels.
  std::function<bool(double part)> progress = {};
};

/// Why the search ended. Only `converged` is success; after any other the state is the last equilibrium found
/// before.
enum class Balance {
  converged,      ///< at the last load and time
  stalled,        ///< no step of the loads or the time is short enough, or rounding hides the tolerance
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
/// unbalanced forces, times l. For loads without an energy the symmetric part of K is used.
struct Stability {
  /// By the smallest eigenvalue.
  enum class Kind {
    stable,   ///< above the threshold
    neutral,  ///< within it
    unstable  ///< below minus the threshold
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
  std::string reason;         ///< one sentence with load, time, rod, node and numbers; empty when converged
  double load = 0.0;          ///< share reached
  Stability stability;        ///< of the state
  bool conservative = true;   ///< all loads have an energy (at a fixed time) and all joints react
  double residual = 0.0;      ///< largest unbalanced force, or torque over l, relative to `force_scale`
  double force_scale = 0.0;   ///< the largest of the loads' sum, a held node's reaction, and B / l^2
  double last_step = 0.0;     ///< what `tolerance` was compared with
  double elastic = 0.0;       ///< energy
  double potential = 0.0;     ///< of the loads that have one, at their last factor
  std::vector<Vec3> support;  ///< per anchor, the force it puts on its node; 0 where it holds no position
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
/// the energy and else always the same. Deterministic. Cost: O(nodes) a factorisation on chains and trees.
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
