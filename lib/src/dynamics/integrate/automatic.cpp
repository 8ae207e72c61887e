#include "automatic.h"

#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/rodas.h>

#include <algorithm>
#include <utility>

#include "dynamics/scene/words.h"

namespace tendril {
namespace {

// A step of RODAS costs about as much as this many of Cash-Karp.
constexpr double kImplicitCost = 4.5;
constexpr double kImplicitCostWithTwist = 12.0;
// No change back and forth: explicit steps must be too dear, or cheap enough, by this factor.
constexpr double kMargin = 2.0;
constexpr long kExplicitInterval = 64;  // accepted steps between looks at the choice
constexpr long kImplicitInterval = 16;  // at first; doubled while far from a change
constexpr long kLongestInterval = 256;

}  // namespace

Automatic::Automatic(const System& system, State start, const SimulationOptions& options,
                     std::unique_ptr<EmbeddedStepper> stepper)
    : ChosenSteps(system, std::move(start), options, std::move(stepper)),
      cost_(system.twist_count() > 0 ? kImplicitCostWithTwist : kImplicitCost),
      implicit_interval_(kImplicitInterval / 2) {}

void Automatic::turn_to(std::unique_ptr<EmbeddedStepper> stepper) {
  other_evaluations_ += stepper_->evaluations();
  stepper_ = std::move(stepper);
  report_.method = stepper_->name();
}

void Automatic::look_again_later(double ratio) {
  const bool far = stepper_->stiff() && ratio > 4.0 * cost_ / kMargin;
  implicit_interval_ =
      far ? std::clamp(2 * implicit_interval_, kImplicitInterval, kLongestInterval) : kImplicitInterval;
}

void Automatic::look_ahead() {
  const bool stiff = stepper_->stiff();
  if (stiff) foresee();
  if (!guard_.since().passed(stiff ? implicit_interval_ : kExplicitInterval)) return;
  measure_guard();
  const bool first = !std::exchange(chosen_, true);
  const double wish = first || stiff ? control_.step() : control_.wish();
  const double ratio = wish / guard_.step();
  const bool too_dear = !stiff && (ratio > kMargin * cost_ || !explicit_fits());
  const bool cheap_enough = stiff && ratio < cost_ / kMargin && explicit_fits();
  if (too_dear) turn_to(std::make_unique<Rodas>(system_));
  if (cheap_enough) turn_to(std::make_unique<CashKarp>(system_));
  if (too_dear || cheap_enough || first)
    report_.switches.push_back({state_.time, report_.method,
                                sentence("accuracy asks for steps of ", wish,
                                         ", the guard of explicit steps allows ", guard_.step())});
  look_again_later(ratio);
}

}  // namespace tendril
