#pragma once

#include <limits>

#include "controller.h"
#include "dynamics/control/guard.h"
#include "dynamics/control/step_control.h"

namespace tendril {

/// A run whose steps are chosen by their errors ([Chan 2008] 3.34), those of an explicit method under the
/// guard against amplified oscillations.
class ChosenSteps : public Controller {
 public:
  ChosenSteps(const System& system, State start, const SimulationOptions& options,
              std::unique_ptr<EmbeddedStepper> stepper);
  void begin(double until) override;
  bool step_towards(double target) override;
  Past past() override;
  void take_over(const Past& past) override;

 protected:
  /// Accepted explicit steps between estimates of the largest frequency: the same whoever chooses the method,
  /// for the same steps.
  static constexpr long kGuardInterval = 128;

  /// Looks at what the next steps depend on, and may stop the run.
  virtual void look_ahead();
  /// Where implicit steps cannot be taken at a state, of whatever length: false where there are no others.
  virtual bool turns_from_implicit(const Evaluation&) { return false; }
  void restart_stepper() override { stepper_->restart(); }
  void begin_anew() override;
  /// Another stepper, or another state.
  void forget_watch() { watched_.reset(), keeping_step_ = std::numeric_limits<double>::infinity(); }
  double keeping_step() const { return keeping_step_; }
  void measure_guard();
  /// Of the explicit steps that the guard is for, and their evaluations.
  virtual Guard::Growth growth() const;
  virtual double explicit_stages() const { return stepper_->stages(); }
  /// Stops where explicit steps cannot reach the end.
  void refuse_where_too_dear();
  /// Evaluations that explicit steps would need from here on, and those that are left.
  double needed() const;
  /// Stops where implicit steps cannot reach the end.
  void foresee();
  double left() const { return static_cast<double>(options_.work_limit - evaluations()); }

  std::unique_ptr<EmbeddedStepper> stepper_;
  Guard guard_;
  StepControl control_;

 private:
  const Stepper& stepper() const override { return *stepper_; }
  bool may_lose_energy() const override { return stepper_->stiff(); }
  bool keeps_tolerance() const override { return true; }
  double longest_step() const;
  Aim aim(double target) const;
  bool jump(const Aim& aim, const Evaluation& last);
  /// \param end  of the step as its stages saw it
  bool renew(const Aim& aim, double end, Evaluation& last);
  double error_with_energy(const Aim& aim, double error);
  double energy_allowance(double h) const;
  double energy_error(const Aim& aim, double error);
  void watch(double h);
  double off_here();
  double gross_error();
  double lost_share(const Energies& at, double off, double time) const;
  void accept(const Aim& aim, double error);
  bool reject(const Aim& aim, std::optional<double> error, const Evaluation& why);
  void stop_without_step(const Evaluation& why);
  double least_step() const;
  std::optional<std::size_t> least_certain() const;

  /// Where the energy balance was off by how much, and steps since.
  struct Watched {
    double time, off;
    long steps;
  };

  /// What accepted steps cost since a time.
  struct Pace {
    double time;
    long evaluations;
  };

  std::optional<Watched> watched_;
  double keeping_step_ = std::numeric_limits<double>::infinity();  ///< that keeps the energy, explicit
  State next_;
  std::optional<Energies> next_energies_;
  double own_error_ = 0.0;           ///< of the last trial, without regard to the energy
  std::optional<double> tolerable_;  ///< a step tried in vain from here, for the energy's sake alone
  long unwatched_ = 0;               ///< steps left in which the energy does not shorten them
  Eigen::VectorXd y_, error_;
  std::optional<Pace> pace_;
  double period_;      ///< shortest, of what acts of itself
  long steps_ = 0;     ///< accepted, in this layout of the scene
  bool keeps_energy_;  ///< nothing takes energy out or puts it in
  bool floats_;        ///< some body is held by nothing
};

}  // namespace tendril
