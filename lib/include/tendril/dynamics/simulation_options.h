#pragma once

#include <tendril/curve/fit.h>
#include <tendril/dynamics/method.h>

#include <functional>
#include <memory>
#include <optional>

namespace tendril {

/// How a run is controlled. Lengths, velocities, angles and spins have error scales of their own: the rods'
/// length l, the largest speed so far (at least sqrt(a l), a the largest acceleration at the start), 1 rad,
/// and speed / l. The speed of a mass lighter than half the mean of its rod counts by the square root of the
/// ratio, for so much less energy it carries, but at least by a hundredth. Of a body: three times its radius
/// of gyration, at most the longest rod (where there is none, the largest radius of gyration), its own
/// largest speed so far, likewise, 1 rad, and that speed over the radius. Of rods that nothing holds, how
/// fast they turn counts by where that takes them before the run ends, and before an anchor lets go all
/// speeds do; a run that is asked for piece by piece (Simulation::run) looks ahead no farther than each
/// piece.
struct SimulationOptions {
  /// How steps are taken. The automatic choice stays with explicit steps where implicit ones would be
  /// refused, as forces couple too much for their equations.
  Method method = Method::automatic;
  /// Makes a stepper of the caller's, instead of the method's. With a fixed step it may be any Stepper;
  /// without it must be an EmbeddedStepper, and one that is not stiff is capped by what its growth() says.
  std::function<std::unique_ptr<Stepper>(const System&)> own_stepper = {};
  /// Step of the methods that do not choose their own. Stretches between outputs, jumps of a
  /// force and the end are divided into equal steps of at most this.
  std::optional<double> fixed_step = {};
  double tolerance = 1e-6;  ///< of a step's error, relative to those scales, largest component
  /// Default: a hundredth of the run, or a tenth of the shortest period, or of the time in which the fastest,
  /// at its acceleration, goes the longest rod's length.
  std::optional<double> first_step = {};
  std::optional<double> largest_step = {};  ///< default: the whole run
  double amplification = 1e-6;  ///< guard: growth of the fastest undamped oscillation allowed in one step
  double total_amplification = 5e-3;  ///< guard: the same over the whole run; half the energy limit
  /// Of the energy balance, relative to the largest energy seen; what speeds of two tolerances' error change
  /// is let pass, and what places of bodies do.
  double energy_limit = 1e-2;
  double drift_limit = 50.0;     ///< of Report::drift, in tolerances
  long work_limit = 20'000'000;  ///< evaluations of the equations
  int degree = 3;                ///< of the curves through the masses (lower for rods of fewer masses)
  Parametrisation parametrisation = Parametrisation::centripetal;  ///< of those curves
};

}  // namespace tendril
