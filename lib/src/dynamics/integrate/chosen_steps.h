#pragma once

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
  /// Looks at what the next steps depend on, and may stop the run.
  virtual void look_ahead();
  void restart_stepper() override { stepper_->restart(); }
  void begin_anew() override;
  void measure_guard();
  /// Evaluations that explicit steps would need from here on, and those that are left.
  double needed() const;
  double left() const { return static_cast<double>(options_.work_limit - evaluations()); }

  std::unique_ptr<EmbeddedStepper> stepper_;
  Guard guard_;
  StepControl control_;

 private:
  const Stepper& stepper() const override { return *stepper_; }
  bool may_lose_energy() const override { return stepper_->stiff(); }
  double longest_step() const;
  Aim aim(double target) const;
  bool jump(const Aim& aim, const Evaluation& last);
  /// \param end  of the step as its stages saw it
  bool renew(const Aim& aim, double end, Evaluation& last);
  void accept(const Aim& aim, double error);
  bool reject(const Aim& aim, std::optional<double> error, const Evaluation& why);
  void stop_without_step(const Evaluation& why);
  double least_step() const;

  State next_;
  Eigen::VectorXd y_, error_;
  bool floats_;  ///< some body is held by nothing
};

}  // namespace tendril
