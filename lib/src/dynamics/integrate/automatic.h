#pragma once

#include <string>

#include "chosen_steps.h"

namespace tendril {

/// A run that turns from explicit steps to implicit ones where the guard's cap makes those dearer than steps
/// as long as accuracy allows, and back.
class Automatic : public ChosenSteps {
 public:
  Automatic(const System& system, State start, const SimulationOptions& options,
            std::unique_ptr<EmbeddedStepper> stepper);

 protected:
  void look_ahead() override;
  bool turns_from_implicit(const Evaluation& why) override;

 private:
  bool explicit_fits() const { return needed() < left(); }
  void turn_to(std::unique_ptr<EmbeddedStepper> stepper);
  void look_again_later(double ratio);
  bool struggles();

  double cost_;                       ///< of an implicit step, in explicit ones
  bool chosen_ = false;               ///< a first choice was made
  bool doubtful_ = false;             ///< and that by the first step alone
  std::string bound_;                 ///< why it cannot turn to implicit steps; empty where it can
  long implicit_interval_;            ///< accepted implicit steps between looks at the choice
  bool decays_ = false;               ///< some spring resists
  bool trial_ = false;                ///< implicit steps are tried, to be looked at soon
  long rejected_ = 0, accepted_ = 0;  ///< steps up to the last look
  long wait_ = 0, longest_wait_ = 1;  ///< looks until the next trial may be
};

}  // namespace tendril
