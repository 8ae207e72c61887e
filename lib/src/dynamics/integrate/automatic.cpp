#include "automatic.h"

#include <tendril/base/error.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/rodas.h>

#include <algorithm>
#include <utility>

#include "dynamics/coupling/elimination.h"
#include "dynamics/scene/model.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

// A step of RODAS costs about as much as this many of Cash-Karp.
constexpr double kImplicitCost = 4.5;
constexpr double kImplicitCostWithTwist = 9.0;
// No change back and forth: explicit steps must be too dear, or cheap enough, by this factor.
constexpr double kMargin = 2.0;
// The first step is a guess: to leave at once they must be dearer by this factor more. Else the next look is
// after this many accepted steps.
constexpr double kCertain = 10.0;
constexpr long kDoubt = 16;
// Accepted implicit steps between looks at the choice, doubled while far from a change.
constexpr long kImplicitInterval = 16;
constexpr long kLongestInterval = 256;
// Of explicit steps between two looks, those in vain that tell of trouble at the cap; and a step near it.
constexpr double kInVain = 0.05, kNearCap = 0.25;
constexpr long kLongestWait = 64;  // looks between two trials

}  // namespace

Automatic::Automatic(const System& system, State start, const SimulationOptions& options,
                     std::unique_ptr<EmbeddedStepper> stepper)
    : ChosenSteps(system, std::move(start), options, std::move(stepper)),
      cost_(system.twist_count() > 0 ? kImplicitCostWithTwist : kImplicitCost),
      implicit_interval_(kImplicitInterval / 2) {
  for (const Model::Segment& segment : model_of(system).segments) decays_ = decays_ || segment.viscous;
  try {
    pattern_of_equations(model_of(system));
  } catch (const InvalidInput& refusal) {
    bound_ = sentence("; implicit steps are refused: ", refusal.what());
  }
}

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

bool Automatic::turns_from_implicit(const Evaluation& why) {
  bound_ = sentence("; implicit steps are refused: ", describe(why.outcome));
  turn_to(std::make_unique<CashKarp>(system_));
  report_.switches.push_back({state_.time, report_.method, describe(why.outcome)});
  return true;
}

/// What decays or rings at the cap is seen by the error estimate of explicit steps, too: the steps that they
/// wish for are no measure of what implicit ones could do. That is found out by trying.
bool Automatic::struggles() {
  const long in_vain = report_.rejected - std::exchange(rejected_, report_.rejected);
  const long accepted = report_.accepted - std::exchange(accepted_, report_.accepted);
  if (wait_ > 0) --wait_;
  const bool often = static_cast<double>(in_vain) > kInVain * static_cast<double>(accepted);
  return wait_ == 0 && (often || decays_) && control_.step() > kNearCap * guard_.step();
}

void Automatic::look_ahead() {
  const bool stiff = stepper_->stiff();
  if (stiff) foresee();
  const bool due = guard_.since().passed(stiff ? implicit_interval_ : kGuardInterval);
  if (!due && !(doubtful_ && guard_.since().passed(kDoubt))) return;
  if (due) measure_guard();
  const bool first = !std::exchange(chosen_, true);
  doubtful_ = first;
  const double wish = first || stiff ? control_.step() : control_.wish();
  const double ratio = wish / guard_.step();
  const bool too_dear = !stiff && (ratio > (first ? kCertain : 1.0) * kMargin * cost_ || !explicit_fits());
  const bool tries = !stiff && due && !first && !too_dear && bound_.empty() && struggles();
  const bool tried = stiff && std::exchange(trial_, false);
  const bool cheap_enough = stiff && ratio < (tried ? cost_ : cost_ / kMargin) && explicit_fits();
  const std::string why =
      sentence("accuracy asks for steps of ", wish, ", the guard of explicit steps allows ", guard_.step());
  const auto tell = [&](const std::string& reason) {
    report_.switches.push_back({state_.time, report_.method, reason});
  };
  if (first) tell(too_dear && bound_.empty() ? "runs begin with explicit steps" : why + bound_);
  if (too_dear && !bound_.empty()) return refuse_where_too_dear();
  if (too_dear || tries) turn_to(std::make_unique<Rodas>(system_));
  if (cheap_enough) turn_to(std::make_unique<CashKarp>(system_));
  if (too_dear || cheap_enough) tell(why);
  if (tries) tell("explicit steps stay at the guard's cap, or are tried in vain there");
  trial_ = tries;
  if (tried && cheap_enough) wait_ = longest_wait_ = std::min(2 * longest_wait_, kLongestWait);
  look_again_later(ratio);
}

}  // namespace tendril
