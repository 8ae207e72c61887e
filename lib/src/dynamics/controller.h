#pragma once

#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/simulation.h>

namespace tendril {

/// Step control of a run: the controller of thesis 3.34, the guard against amplified oscillations, the
/// limits, and the book of what happened.
class Controller {
 public:
  Controller(const System& system, State start, const SimulationOptions& options);

  void begin(double until);
  bool running() const { return !ended_ && state_.time < until_; }

  /// One accepted step, ending at `target` if it reaches that far. False when the run has to stop.
  bool step_towards(double target);
  void cancel();

  const State& state() const { return state_; }
  System::Workspace& workspace() { return stepper_.workspace(); }
  Report report();

 private:
  struct Aim {
    double h, time;
    bool at_break;
  };
  Aim aim(double target);
  double error_norm(const Eigen::VectorXd& error) const;
  void measure_scales();
  void guard();
  void accept(const Aim& aim, double error);
  bool reject(const Aim& aim, double factor, const Evaluation& why);
  void check_energy();
  double imbalance() const;
  void stop(Stop why, std::string reason);
  std::string place(std::size_t node) const;

  const System& system_;
  SimulationOptions options_;
  State state_;
  CashKarp stepper_;
  Eigen::VectorXd y_, error_;

  double until_ = 0.0, start_ = 0.0, h_ = 0.0;
  bool ended_ = false;
  std::vector<double> breaks_;
  std::vector<double> rod_length_;
  double speed_ = 0.0, longest_ = 0.0, guard_frequency_ = -1.0;
  double energy_scale_ = 0.0;
  long since_guard_ = 0, other_evaluations_ = 0;
  Energies now_;
  Report report_;
};

}  // namespace tendril
