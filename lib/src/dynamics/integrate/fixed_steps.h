#pragma once

#include "controller.h"
#include "dynamics/control/guard.h"

namespace tendril {

/// A run by steps of a fixed size: stretches between outputs and jumps in equal steps of at most that. Beyond
/// the stability limit of the table of methods it is refused.
class FixedSteps : public Controller {
 public:
  FixedSteps(const System& system, State start, const SimulationOptions& options,
             std::unique_ptr<Stepper> stepper);
  void begin(double until) override;
  bool step_towards(double target) override;

 private:
  const Stepper& stepper() const override { return *stepper_; }
  void restart_stepper() override { stepper_->restart(); }
  void check_stability();
  Aim aim(double target) const;
  bool advance(double h);

  std::unique_ptr<Stepper> stepper_;
  double step_;
  StabilityLimits limits_;
  Interval since_check_;
  State next_;
};

}  // namespace tendril
