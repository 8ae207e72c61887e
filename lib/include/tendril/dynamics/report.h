#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/state.h>

#include <string>
#include <vector>

namespace tendril {

/// Why a run ended. Only `finished` is success; after any other the state is that of the last good step.
enum class Stop {
  finished,        ///< at the time asked for
  cancelled,       ///< the progress callback asked for it
  too_stiff,       ///< the guard's step exceeds the work limit, or a fixed step the stability limit
  work_limit,      ///< the limit was reached
  step_underflow,  ///< no step large enough to advance the time meets the tolerance
  not_evaluable,   ///< zero-length edge, fold-back, no finite number, a force's refusal or an implicit step
                   ///< without solution, at every step size (or the fixed one)
  energy_lost,  ///< energy went beyond the energy limit, or so that the motion is off beyond the drift limit
  energy_gained,  ///< the same where it came
  momentum_lost,  ///< a body's angular momentum changed that nothing turns, beyond the drift limit
};
/// The enumerator's name.
TENDRIL_CORE_API const char* to_string(Stop stop);

/// A change of method during an automatic run.
struct Switch {
  double time;         ///< of the change
  std::string to;      ///< the stepper's name
  std::string reason;  ///< one sentence with the numbers
};

/// What a run came to.
struct Report {
  Stop stop = Stop::finished;      ///< why it ended
  std::string method;              ///< the stepper's name, the last one's of an automatic run
  std::vector<Switch> switches;    ///< of an automatic run: what it began with, and every change
  std::string reason;              ///< one sentence with time, rod, node and numbers; empty when finished
  double time = 0.0;               ///< reached
  long accepted = 0;               ///< steps
  long rejected = 0;               ///< steps tried again, shorter
  long evaluations = 0;            ///< of the equations
  double smallest_step = 0.0;      ///< accepted
  double largest_step = 0.0;       ///< accepted
  double largest_frequency = 0.0;  ///< last estimate [rad / time]
  double guard_step = 0.0;         ///< last cap on the step by the guard; infinite when nothing limits it
  Energies first;                  ///< at the start
  Energies last;                   ///< at the end
  double work = 0.0;               ///< by forces without energy, damping, anchors, Simulation::change
  double changed = 0.0;            ///< of it, by Simulation::change: negative where impacts take energy
  double imbalance = 0.0;          ///< (last - first - work) / largest energy seen
  /// How far energy or angular momentum that went astray put the motion off, estimated, in lengths of a rod:
  /// of methods that choose their steps.
  double drift = 0.0;
};

}  // namespace tendril
