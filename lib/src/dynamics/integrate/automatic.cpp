#include "automatic.h"

#include <tendril/base/error.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/nystrom.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/stability.h>

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
constexpr double kCertain = 10.0, kCertainWide = 3.0;
constexpr long kDoubt = 16;
// Accepted implicit steps between looks at the choice, doubled while far from a change.
constexpr long kImplicitInterval = 16;
constexpr long kLongestInterval = 256;
// Of explicit steps between two looks, those in vain that tell of trouble at the cap; and a step near it.
constexpr double kInVain = 0.05, kNearCap = 0.25;
// Nystrom's wish for steps this much shorter than would pay is reason enough, where that many are left; and
// steps of a trial.
constexpr double kTrialMargin = 4.0, kWorthTrial = 400.0;
constexpr long kTrial = 4;
constexpr long kLongestWait = 64;  // looks between two trials
// Of Nystrom's, in Cash-Karp's; and tolerances that their loss of energy may put a run off by at its end.
constexpr double kWideCost = 0.85, kWideDrift = 2.0;
constexpr double kAtOnce = 0.05;  // of these at any time

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

/// To one that was in use before, or a new one.
template <class S>
void Automatic::turn_to() {
  other_evaluations_ += stepper_->evaluations();
  const auto is = [](const auto& stepper) { return dynamic_cast<const S*>(stepper.get()) != nullptr; };
  const auto found = std::find_if(idle_.begin(), idle_.end(), is);
  std::unique_ptr<EmbeddedStepper> next =
      found == idle_.end() ? std::make_unique<S>(system_) : std::exchange(*found, nullptr);
  if (found != idle_.end()) idle_.erase(found);
  idle_.push_back(std::exchange(stepper_, std::move(next)));
  other_evaluations_ -= stepper_->evaluations();
  stepper_->restart();
  report_.method = stepper_->name();
  looked_ = state_.time;
  stepped_ = report_.accepted;
  forget_watch();
}

void Automatic::look_again_later(double ratio) {
  const bool far = stepper_->stiff() && ratio > 4.0 * cost_ / kMargin;
  implicit_interval_ =
      far ? std::clamp(2 * implicit_interval_, kImplicitInterval, kLongestInterval) : kImplicitInterval;
}

bool Automatic::turns_from_implicit(const Evaluation& why) {
  bound_ = sentence("; implicit steps are refused: ", describe(why.outcome));
  turn_to_explicit();
  tell(describe(why.outcome));
  return true;
}

void Automatic::turn_to_explicit() {
  if (wide_)
    turn_to<Nystrom>();
  else
    turn_to<CashKarp>();
}

void Automatic::tell(std::string reason) {
  report_.switches.push_back({state_.time, report_.method, std::move(reason)});
}

Guard::Growth Automatic::growth() const {
  return wide_ ? nystrom_growth : cash_karp_growth;
}

double Automatic::cost() const {
  return wide_ ? cost_ / kWideCost : cost_;
}

/// Nystrom's steps may be some six times as long where nothing damps, and are cheaper.
bool Automatic::widens(double wish) {
  if (wide_ || !may_widen_ || !(wish > guard_.step())) return false;
  wide_ = true;
  guard_.cap(nystrom_growth);
  report_.guard_step = guard_.step();
  return true;
}

/// Their error is estimated with one order less: where the tolerance is tight, Cash-Karp's at its cap are
/// cheaper.
bool Automatic::narrows(double wish) {
  if (!wide_) return false;
  const double narrow = guard_.step_of(cash_karp_growth);
  // By what a time unit costs.
  const double dearer = info(Method::cash_karp).stages / explicit_stages();
  if (!drifts() && dearer * wish > narrow) return false;
  may_widen_ = false;
  narrow_down();
  return true;
}

void Automatic::narrow_down() {
  wide_ = false;
  guard_.cap(cash_karp_growth);
  report_.guard_step = guard_.step();
}

/// By how much implicit steps have to be cheaper. At Nystrom's cap the fastest motions are seen by the error
/// estimate: the steps that it wishes for are short ones.
double Automatic::margin(bool first) const {
  if (wide_) return first ? kCertainWide : 1.0;
  return first ? kCertain * kMargin : kMargin;
}

/// The next one, or the mean of those since the last look, where that is longer: single ones say little.
double Automatic::implicit_step() {
  const double time = state_.time - std::exchange(looked_, state_.time);
  const long steps = report_.accepted - std::exchange(stepped_, report_.accepted);
  return steps > 0 ? std::max(control_.step(), time / static_cast<double>(steps)) : control_.step();
}

/// They take energy out of what turns by much of a radian a step.
bool Automatic::drifts() const {
  const double done = (state_.time - start_) / (until_ - start_);
  return report_.drift > kWideDrift * options_.tolerance * std::max(done, kAtOnce);
}

/// What decays or rings at the cap is seen by the error estimate of explicit steps, too: the steps that they
/// wish for are no measure of what implicit ones could do. That is found out by trying.
bool Automatic::struggles(double ratio) {
  const long in_vain = report_.rejected - std::exchange(rejected_, report_.rejected);
  const long accepted = report_.accepted - std::exchange(accepted_, report_.accepted);
  if (wait_ > 0) --wait_;
  const bool often = static_cast<double>(in_vain) > kInVain * static_cast<double>(accepted);
  const bool worth_it = needed() > kWorthTrial * explicit_stages();
  const bool trouble = wide_ ? ratio > cost() / kTrialMargin && worth_it : often;
  return wait_ == 0 && (trouble || decays_) && control_.step() > kNearCap * guard_.step();
}

/// What is asked for and what is allowed.
/// \param narrow  what Cash-Karp may take, where Nystrom takes its place
std::string Automatic::in_words(double wish, std::optional<double> narrow) const {
  const std::string asks =
      sentence("accuracy asks for steps of ", wish, ", the guard of explicit steps allows ");
  return (narrow ? sentence(asks, *narrow, " to Cash-Karp and ", guard_.step(), " to Nystrom")
                 : sentence(asks, guard_.step())) +
         bound_;
}

void Automatic::look_ahead() {
  const bool stiff = stepper_->stiff();
  if (stiff) foresee();
  const bool due = guard_.since().passed(
      stiff ? (trial_ ? std::min(kTrial, implicit_interval_) : implicit_interval_) : kGuardInterval);
  const bool drifting = wide_ && !stiff && drifts();
  if (!due && !drifting && !(doubtful_ && guard_.since().passed(kDoubt))) return;
  if (due) measure_guard();
  const bool first = !std::exchange(chosen_, true);
  doubtful_ = first;
  const double wish = first ? control_.step() : stiff ? implicit_step() : control_.wish();
  const double narrow = guard_.step();
  const bool widened = widens(wish), turned = widened || (!stiff && narrows(std::min(wish, keeping_step())));
  const double ratio = wish / guard_.step();
  const bool too_dear = !stiff && (ratio > margin(first) * cost() || !explicit_fits());
  const bool tries = !stiff && due && !first && !too_dear && bound_.empty() && struggles(ratio);
  const bool tried = stiff && std::exchange(trial_, false);
  const bool cheap_enough = stiff && ratio < (tried ? cost() : cost() / kMargin) && explicit_fits();
  // What moves fast enough to ask for so short steps is more than a ringing.
  if (cheap_enough && wide_ && wish <= guard_.step_of(cash_karp_growth)) narrow_down();
  const bool to_implicit = (too_dear && bound_.empty()) || tries;
  const bool to_explicit = cheap_enough || (turned && !stiff && !to_implicit);
  const std::string why = in_words(wish, widened && !to_implicit ? std::optional(narrow) : std::nullopt);
  const bool loses = drifting || (to_explicit && !wide_ && !stiff && keeping_step() < wish);
  if (first) tell(to_implicit || to_explicit ? "runs begin with explicit steps" : why);
  if (to_implicit)
    turn_to<Rodas>();
  else if (to_explicit)
    turn_to_explicit();
  if (to_implicit || to_explicit)
    tell(tries   ? "explicit steps stay at the guard's cap, or are tried in vain there"
         : loses ? "steps lose energy"
                 : why);
  if (too_dear && !bound_.empty()) return refuse_where_too_dear();
  trial_ = tries;
  if (tried && cheap_enough) wait_ = longest_wait_ = std::min(2 * longest_wait_, kLongestWait);
  look_again_later(ratio);
}

}  // namespace tendril
