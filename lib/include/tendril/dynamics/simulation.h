#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/follower.h>
#include <tendril/dynamics/method.h>

#include <functional>
#include <optional>
#include <string>

namespace tendril {

/// How a run is controlled. Lengths, velocities, angles and spins have error scales of their own: the rods'
/// length l, the largest speed so far (at least sqrt(a l), a the largest acceleration at the start), 1 rad,
/// and speed / l. The speed of a mass lighter than half the mean of its rod counts by the square root of the
/// ratio, for so much less energy it carries, but at least by a hundredth.
struct SimulationOptions {
  Method method = Method::cash_karp;
  /// Makes a stepper of one's own, in place of the method. With a fixed step it may be any Stepper; without
  /// it must be an EmbeddedStepper, and one that is not stiff is capped by Cash-Karp's guard.
  std::function<std::unique_ptr<Stepper>(const System&)> own_stepper = {};
  /// Step of the methods that do not choose their own. Stretches between outputs, jumps of a
  /// force and the end are divided into equal steps of at most this.
  std::optional<double> fixed_step = {};
  double tolerance = 1e-6;                ///< of a step's error, relative to those scales, largest component
  std::optional<double> first_step = {};  ///< default: a hundredth of the run, capped by the guard
  std::optional<double> largest_step = {};  ///< default: the whole run
  double amplification = 1e-6;  ///< guard: growth of the fastest undamped oscillation allowed in one step
  double total_amplification = 0.1;  ///< guard: the same over the whole run
  double energy_limit = 1e-2;        ///< of the energy balance, relative to the largest energy seen
  long work_limit = 20'000'000;      ///< evaluations of the equations
  int degree = 3;                    ///< of the curves through the masses (lower for rods of fewer masses)
  Parametrisation parametrisation = Parametrisation::centripetal;
};

/// Why a run ended. Only `finished` is success; after any other the state is that of the last good step.
enum class Stop {
  finished,
  cancelled,       ///< the progress callback asked for it
  too_stiff,       ///< the guard's step exceeds the work limit, or a fixed step the stability limit
  work_limit,      ///< the limit was reached on the way
  step_underflow,  ///< no step large enough to move the clock meets the tolerance
  not_evaluable,   ///< zero-length edge, fold-back, no finite number, a force's refusal or an implicit step
                   ///< without solution, at every step size (or the fixed one)
  energy_lost,     ///< the energy balance is off by more than the energy limit
};
TENDRIL_CORE_API const char* to_string(Stop stop);

/// A change of method during an automatic run.
struct Switch {
  double time;
  std::string to;      ///< the stepper's name
  std::string reason;  ///< one sentence with the numbers
};

struct Report {
  Stop stop = Stop::finished;
  std::string method;            ///< the stepper's name, the last one's of an automatic run
  std::vector<Switch> switches;  ///< of an automatic run: what it began with, and every change
  std::string reason;            ///< one sentence with time, rod, node and numbers; empty when finished
  double time = 0.0;
  long accepted = 0, rejected = 0, evaluations = 0;
  double smallest_step = 0.0, largest_step = 0.0;
  double largest_frequency = 0.0;  ///< last estimate [rad / time]
  double guard_step = 0.0;         ///< last cap on the step by the guard; infinite when nothing limits it
  Energies first, last;
  double work = 0.0;       ///< by forces without energy, damping, anchors, Simulation::change
  double changed = 0.0;    ///< of it, by Simulation::change: negative where impacts take energy
  double imbalance = 0.0;  ///< (last - first - work) / largest energy seen
};

/// Moves a system by Cash-Karp 4(5) with the controller of thesis 3.34 (safety 0.93, exponents 0.2 and 0.25,
/// factor bounded to [0.2, 5]) under a guard: the pair amplifies undamped oscillations (|R(iy)| - 1 = y^6 /
/// 7200), so the step is capped by an estimate of the largest frequency. Or, when the options say so, by a
/// method of fixed step under the same watch on energy and work; velocity Verlet and Runge-Kutta 4 refuse
/// steps beyond their stability limits. Same scene, same bits.
class TENDRIL_CORE_API Simulation {
 public:
  enum class When { accepted_step, output };

  /// \param system  kept by reference
  /// InvalidInput: options out of range, a start that cannot be evaluated, forces that couple too much.
  Simulation(const System& system, State start, const SimulationOptions& options = {});
  ~Simulation();

  /// \param follower  kept by reference; followers are called in the order they were added
  void add(Follower& follower, When when);
  /// Called after every accepted step with the time reached; false cancels.
  void on_progress(std::function<bool(double time)> progress);

  /// Runs on to time `until`, calling followers at accepted steps and at each of `outputs` (ascending, within
  /// the run; the start only when it is among them). May be called again to go on.
  Report run(double until, std::span<const double> outputs = {});

  /// Changes what y holds between two steps, as an impact does: between runs, or from a follower or the
  /// progress callback. Steppers begin anew, Force::remember is called, energy gained or lost is work. Throws
  /// InvalidInput, nothing changed, for another time or size or where the equations cannot be evaluated.
  void change(const std::function<void(State&)>& how);
  const State& state() const;
  std::span<const CurvePair> pairs() const;  ///< the curve-pairs at the present state, one per rod
  /// Parameters of the masses on their rod's curve.
  std::span<const double> parameters(std::size_t rod) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
