#pragma once

#include <tendril/dynamics/simulation.h>

#include <memory>

#include "dynamics/control/drift.h"
#include "dynamics/control/energy_balance.h"
#include "dynamics/control/error_scale.h"
#include "dynamics/control/target.h"

namespace tendril {

/// A run under way: where it stands, how far it is to go and why it ended, with the book of what happened and
/// the limits on energy and work. How its steps are chosen is for the classes that derive from it.
class Controller {
 public:
  virtual ~Controller() = default;

  virtual void begin(double until);
  bool running() const { return !ended_ && state_.time < until_; }

  /// One accepted step, ending at `target` if it reaches that far. False when the run has to stop.
  virtual bool step_towards(double target) = 0;
  void cancel();
  /// Another state takes the place of this one between two steps.
  /// \param state  at the same time, rebased
  void change(State state);
  void refuse_release();

  /// What goes on where the scene is laid out anew.
  struct Past {
    Report report;
    EnergyBalance energy;
    Drift drift;
    std::vector<ErrorScale::Speed> speeds;
    double start;
    long evaluations;
    std::optional<double> step;  ///< the next one, where steps are chosen
  };
  virtual Past past();
  /// Goes on where another run stopped, in the same scene laid out anew at the same time.
  virtual void take_over(const Past& past);

  const State& state() const { return state_; }
  System::Workspace& workspace() { return *work_; }
  const SimulationOptions& options() const { return options_; }
  Report report();

 protected:
  Controller(const System& system, State start, const SimulationOptions& options, const Stepper& stepper);

  long evaluations() const { return other_evaluations_ + stepper().evaluations(); }
  bool out_of_work();
  void record(const Aim& aim);
  /// What the stepper kept is of no use any more; nor, after begin_anew, what is known of the motion.
  virtual void restart_stepper() = 0;
  virtual void begin_anew() { restart_stepper(); }
  void stop(Stop why, std::string reason);
  std::string name_of(std::size_t node) const;
  /// Whether the forces that may refuse a state let a step end there.
  Evaluation asks(const State& state);
  /// Looks at the energies of the present state, and stops the run where the balance is off.
  void judge(const Energies& energies);

  const System& system_;
  SimulationOptions options_;
  State state_;
  System::WorkspacePtr work_;
  Breaks breaks_;
  ErrorScale scale_;
  EnergyBalance energy_;
  Drift drift_;
  double until_, start_;
  bool ended_ = false;
  long other_evaluations_ = 0;  ///< by others than the stepper
  Report report_;               ///< without what report() adds

 private:
  virtual const Stepper& stepper() const = 0;
  /// A stiff method that chooses its steps takes energy out of what it does not resolve; none may put energy
  /// in.
  virtual bool may_lose_energy() const { return false; }
  /// Whether the run was told a tolerance that its motion has to keep.
  virtual bool keeps_tolerance() const { return false; }
  void measure_scales();
  void check_energy();
  void judge_drift();
  bool tolerates(const Energies& energies) const;
  void remember();

  bool may_be_refused_ = false;
};

/// A run as the options ask for it.
std::unique_ptr<Controller> make_controller(const System& system, State start,
                                            const SimulationOptions& options);

}  // namespace tendril
