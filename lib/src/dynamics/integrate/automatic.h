#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chosen_steps.h"

namespace tendril {

/// A run that begins with Cash-Karp's steps, turns to Nystrom's where the guard caps those, and to implicit
/// ones where the cap on these makes them dearer than steps as long as accuracy allows, and back.
class Automatic : public ChosenSteps {
 public:
  Automatic(const System& system, State start, const SimulationOptions& options,
            std::unique_ptr<EmbeddedStepper> stepper);

 protected:
  void look_ahead() override;
  bool turns_from_implicit(const Evaluation& why) override;
  Guard::Growth growth() const override;
  double explicit_stages() const override { return info(wide_ ? Method::nystrom : Method::cash_karp).stages; }

 private:
  bool explicit_fits() const { return needed() < left(); }
  double cost() const;
  template <class S>
  void turn_to();
  void turn_to_explicit();
  void tell(std::string reason);
  std::string in_words(double wish, std::optional<double> narrow) const;
  bool widens(double wish);
  bool narrows(double wish);
  void narrow_down();
  bool drifts() const;
  void look_again_later(double ratio);
  bool struggles(double ratio);
  double margin(bool first) const;
  double implicit_step();

  std::vector<std::unique_ptr<EmbeddedStepper>> idle_;  ///< used before: to come back to
  double cost_;                                         ///< of an implicit step, in Cash-Karp's
  bool wide_ = false;                                   ///< explicit steps are Nystrom's
  bool may_widen_ = true;                               ///< may become so
  bool chosen_ = false;                                 ///< a first choice was made
  bool doubtful_ = false;                               ///< and that by the first step alone
  std::string bound_;                 ///< why it cannot turn to implicit steps; empty where it can
  long implicit_interval_;            ///< accepted implicit steps between looks at the choice
  bool decays_ = false;               ///< some spring resists
  bool trial_ = false;                ///< implicit steps are tried, to be looked at soon
  double looked_ = 0.0;               ///< time of the last look at implicit steps
  long stepped_ = 0;                  ///< and steps up to then
  long rejected_ = 0, accepted_ = 0;  ///< steps up to the last look
  long wait_ = 0, longest_wait_ = 1;  ///< looks until the next trial may be
};

}  // namespace tendril
