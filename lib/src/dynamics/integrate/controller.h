#pragma once

#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/simulation.h>

namespace tendril {

/// Step control of a run: the controller of thesis 3.34 with the guard against amplified oscillations, or
/// fixed steps with their stability limits (fixed_step.cpp); the limits on energy and work, and the book of
/// what happened.
class Controller {
 public:
  Controller(const System& system, State start, const SimulationOptions& options);
  /// Goes on where another stopped, in the same scene laid out anew: its steppers begin anew, its book is
  /// kept. \param state  the other's, rebased in the new system
  Controller(const System& system, State state, Controller& before);

  void begin(double until);
  bool running() const { return !ended_ && state_.time < until_; }

  /// One accepted step, ending at `target` if it reaches that far. False when the run has to stop.
  bool step_towards(double target);
  void cancel();
  void refuse_release();

  const State& state() const { return state_; }
  System::Workspace& workspace() { return *work_; }
  Report report();

 private:
  struct Aim {
    double h, time;
    bool at_break;
  };
  bool cut_at_break(double& target) const;
  Aim aim(double target) const;
  Aim fixed_aim(double target) const;
  double seen(const Aim& aim) const;
  bool fixed_step_towards(double target);
  void guard_fixed_step();
  long evaluations() const {
    return other_evaluations_ + (fixed_ ? fixed_->evaluations() : embedded_->evaluations());
  }
  bool out_of_work();
  void take_speed();
  double error_norm(const Eigen::VectorXd& error) const;
  void make_steppers();
  bool automatic() const;
  void measure_scales();
  void guard();
  double longest_step() const;
  void measure_guard();
  bool explicit_fits() const;
  void choose();
  void take(std::unique_ptr<EmbeddedStepper> stepper, std::string reason);
  void accept(const Aim& aim, double error);
  void record(const Aim& aim);
  bool reject(const Aim& aim, double factor, const Evaluation& why);
  void check_energy();
  double imbalance() const;
  void stop(Stop why, std::string reason);
  std::string place(std::size_t node) const;

  const System& system_;
  SimulationOptions options_;
  State state_, next_;
  System::WorkspacePtr work_;
  std::unique_ptr<EmbeddedStepper> embedded_;  ///< null where steps are fixed
  std::unique_ptr<Stepper> fixed_;             ///< null where the run chooses its steps
  Eigen::VectorXd y_, error_;

  double until_ = 0.0, start_ = 0.0, h_ = 0.0;
  bool ended_ = false;
  std::vector<double> breaks_;
  std::vector<double> rod_length_;
  std::vector<double> speed_share_;  ///< per node, what an error of its velocity counts
  double speed_ = 0.0, longest_ = 0.0, guard_frequency_ = -1.0;
  double energy_scale_ = 0.0;
  double wished_ = 0.0;                        ///< the step the last error would have allowed, uncapped
  double last_error_ = 0.0, last_step_ = 0.0;  ///< of the last accepted step of a stiff method
  bool rejected_ = false;                      ///< a step was tried in vain since
  bool started_ = false;
  bool floats_ = false;  ///< some body is held by nothing
  long since_guard_ = 0, implicit_interval_ = 0, other_evaluations_ = 0;
  Energies now_;
  Report report_;
};

}  // namespace tendril
