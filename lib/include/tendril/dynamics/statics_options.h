#pragma once

#include <functional>
#include <optional>

namespace tendril {

/// How an equilibrium is searched for. Lengths compare with the longest rod's length l at rest.
struct StaticsOptions {
  /// Which equilibrium is followed.
  enum class Seek {
    stable,  ///< down the energy, off every branch that has become unstable
    nearest  ///< along the branch, stable or not
  };
  Seek seek = Seek::stable;  ///< which one

  /// Factor on all loads at the start: by default 0, or `last_load` where no rod bends, since without loads
  /// such chains have no shape of their own.
  std::optional<double> first_load = {};
  double last_load = 1.0;  ///< the factor they grow to, at the start's time
  /// Then anchors and forces are followed in time until then (default: not at all).
  std::optional<double> until = {};

  /// Of the last Newton step: its largest position over l or angle, or, less along soft directions, the root
  /// of the energy it gains over B / l (the bending stiffness of the softest rod, over its length). Where
  /// rounding of the positions hides it, balance decides alone: see Equilibrium::last_step.
  double tolerance = 1e-9;
  double largest_step = 1.0;  ///< share of the loads' range, and of the time's, in one step: 0 to 1
  long work_limit = 20'000;   ///< factorisations of the tangent
  /// Called after every step with the share of the whole done, 0 to 1; false cancels.
  std::function<bool(double part)> progress = {};
};

}  // namespace tendril
