#include "fixed_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/scene/words.h"

namespace tendril {
namespace {

// Accepted steps between estimates of the largest frequency: a twentieth of the cheapest method's work.
constexpr long kCheckInterval = 640;

/// Beyond which a run is refused. Of a stepper of one's own nothing is known; of a method that amplifies
/// every oscillation the energy tells.
StabilityLimits limits_of(const SimulationOptions& options) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  if (options.own_stepper || info(options.method).stability.oscillation == 0.0) return {kAny, kAny};
  return info(options.method).stability;
}

}  // namespace

FixedSteps::FixedSteps(const System& system, State start, const SimulationOptions& options,
                       std::unique_ptr<Stepper> stepper)
    : Controller(system, std::move(start), options, *stepper),
      stepper_(std::move(stepper)),
      step_(*options.fixed_step),
      limits_(limits_of(options)) {}

void FixedSteps::begin(double until) {
  Controller::begin(until);
  since_check_.end_at_once();
}

void FixedSteps::check_stability() {
  since_check_.begin_anew();
  other_evaluations_ += kFrequencyCost;
  const double w = fastest_motion(system_, state_, workspace());
  report_.largest_frequency = w;
  double decay = 0.0;
  for (const Rod& rod : system_.scene().rods)
    decay = std::max(decay, rod.mass_damping + rod.viscosity * w * w);
  report_.guard_step = std::min(limits_.oscillation / w, limits_.decay / decay);
  if (step_ >= report_.guard_step)
    stop(Stop::too_stiff,
         sentence("at time ", state_.time, " the fastest motion has ", w,
                  " rad per time unit and decays with ", decay, ": ", report_.method, " needs steps below ",
                  report_.guard_step, ", and the fixed step is ", step_));
}

Aim FixedSteps::aim(double target) const {
  const Stretch stretch = breaks_.from(state_.time, target);
  const double left = stretch.end - state_.time;
  const double count = std::ceil(left / step_ - 1e-9);
  if (count <= 1.0) return {left, stretch.end, stretch.at_break};
  return {left / count, state_.time + left / count, false};
}

bool FixedSteps::advance(double h) {
  next_ = state_;
  Evaluation result = stepper_->advance(next_, h);
  if (result.ok()) result = asks(next_);
  if (!result.ok()) {
    const bool at_a_node = result.outcome != Evaluation::Outcome::not_converged;
    stop(Stop::not_evaluable, sentence("at time ", state_.time, at_a_node ? ", " + name_of(result.node) : "",
                                       ": ", describe(result.outcome)));
    return false;
  }
  std::swap(state_, next_);
  return true;
}

bool FixedSteps::step_towards(double target) {
  if (since_check_.passed(kCheckInterval)) check_stability();
  if (ended_ || out_of_work()) return false;
  const Aim at = aim(target);
  if (!(at.time > state_.time)) {
    stop(Stop::step_underflow,
         sentence("at time ", state_.time, " a step of ", at.h, " does not advance the time"));
    return false;
  }
  const double h = at.seen(state_.time);
  // Between here and a jump there may be nothing.
  if (state_.time + h > state_.time && !advance(h)) return false;
  state_.time = at.time;
  if (at.at_break) stepper_->restart();
  since_check_.count();
  record(at);
  return !ended_;
}

}  // namespace tendril
