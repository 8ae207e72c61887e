#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/follower.h>
#include <tendril/dynamics/report.h>
#include <tendril/dynamics/simulation_options.h>

#include <functional>
#include <optional>
#include <string>

namespace tendril {

/// Moves a system by Cash-Karp 4(5) with the controller of [Chan 2008] 3.34 (safety 0.93, exponents 0.2 and
/// 0.25, factor bounded to [0.2, 5]) under a guard: the pair amplifies undamped oscillations (|R(iy)| - 1 =
/// y^6 / 7200), so the step is capped by an estimate of the largest frequency. Where that shortens it, by
/// Nystrom's (nystrom.h), of which the cap is wider; where those are dearer than implicit steps, by these
/// (rodas.h). Either is shortened where it would lose energy that puts the motion off. Or, when the options
/// say so, by one of them alone, or by a method of fixed step under the same watch on energy and
/// work; velocity Verlet and Runge-Kutta 4 refuse steps beyond their stability limits. Same scene, same bits.
class TENDRIL_CORE_API Simulation {
 public:
  /// When a follower is called.
  enum class When {
    accepted_step,  ///< after every accepted step
    output          ///< at the output times of run()
  };

  /// InvalidInput: options out of range, a start that cannot be evaluated, forces that couple too much.
  /// \param system   kept by reference
  /// \param start    copied; rest_state() of the system, or any state of it
  /// \param options  see there
  Simulation(const System& system, State start, const SimulationOptions& options = {});
  ~Simulation();

  /// \param follower  kept by reference; followers are called in the order they were added
  /// \param when      it is called
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
  const State& state() const;                ///< the present one
  std::span<const CurvePair> pairs() const;  ///< the curve-pairs at the present state, one per rod
  /// Parameters of the masses on their rod's curve.
  std::span<const double> parameters(std::size_t rod) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
