#include "chosen_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/scene/free_bodies.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

constexpr double kLongestPhase = 1e5;  // of the fastest motion in an implicit step: rounding grows to 1e-6
constexpr long kLongRun = 32;          // accepted implicit steps after which that is asked
constexpr long kGuardInterval = 128;   // accepted steps between estimates of the largest frequency

}  // namespace

ChosenSteps::ChosenSteps(const System& system, State start, const SimulationOptions& options,
                         std::unique_ptr<EmbeddedStepper> stepper)
    : Controller(system, std::move(start), options, *stepper),
      stepper_(std::move(stepper)),
      guard_(system_, options_),
      floats_(has_free_body(model_of(system))) {}

void ChosenSteps::begin(double until) {
  Controller::begin(until);
  guard_.since().end_at_once();
  stepper_->go_on();
  const double run = until - state_.time;
  if (run > 0.0) control_.begin(options_.first_step.value_or(run / 100));
}

Controller::Past ChosenSteps::past() {
  Past result = Controller::past();
  result.step = control_.step();
  return result;
}

void ChosenSteps::take_over(const Past& past) {
  Controller::take_over(past);
  if (past.step) control_.begin(*past.step);
}

void ChosenSteps::measure_guard() {
  other_evaluations_ += kFrequencyCost;
  guard_.measure(state_, until_ - start_, workspace());
  report_.largest_frequency = guard_.last_frequency();
  report_.guard_step = guard_.step();
}

void ChosenSteps::begin_anew() {
  restart_stepper();
  guard_.since().end_at_once();
}

double ChosenSteps::needed() const {
  return 6.0 * (until_ - state_.time) / guard_.step();
}

void ChosenSteps::look_ahead() {
  if (stepper_->stiff()) {
    if (floats_ && report_.accepted == kLongRun && !guard_.frequency()) measure_guard();
    return;
  }
  if (!guard_.since().passed(kGuardInterval)) return;
  measure_guard();
  if (needed() > left())
    stop(Stop::too_stiff, sentence("at time ", state_.time, " the fastest motion has ",
                                   report_.largest_frequency, " rad per time unit, which caps the step at ",
                                   report_.guard_step, ": the rest of the run would need about ", needed(),
                                   " evaluations and ", left(), " are left"));
}

/// An implicit step's equations weigh the springs by (h omega)^2 against the masses: their rounding turns and
/// shakes a body that nothing holds in place.
double ChosenSteps::longest_step() const {
  if (!stepper_->stiff()) return guard_.step();
  const double w = guard_.frequency().value_or(0.0);
  return floats_ && w > 0.0 ? kLongestPhase / w : std::numeric_limits<double>::infinity();
}

Aim ChosenSteps::aim(double target) const {
  double h = std::min({control_.step(), longest_step(), longest_turn(system_, state_),
                       options_.largest_step.value_or(until_ - start_)});
  const Stretch stretch = breaks_.from(state_.time, target);
  const double left = stretch.end - state_.time;
  if (h >= left * (1.0 - 1e-10)) return {left, stretch.end, stretch.at_break};
  // Two equal steps rather than one and a crumb.
  if (2.0 * h > left) h = 0.5 * left;
  return {h, state_.time + h, false};
}

bool ChosenSteps::step_towards(double target) {
  look_ahead();
  Evaluation last;
  while (!ended_ && !out_of_work()) {
    const Aim at = aim(target);
    const double h = at.seen(state_.time);
    if (!(state_.time + h > state_.time)) return jump(at, last);
    last = stepper_->step(state_, h, y_, error_);
    const double error = last.ok() ? scale_.norm(error_) / options_.tolerance : 0.0;
    if (last.ok() && error <= 1.0 && renew(at, state_.time + h, last)) {
      accept(at, error);
      return !ended_;
    }
    if (!reject(at, last.ok() ? std::optional(error) : std::nullopt, last)) break;
  }
  return false;
}

/// Nothing lies between here and the aim: across a jump that is all there is to do.
bool ChosenSteps::jump(const Aim& aim, const Evaluation& last) {
  state_.time = aim.time;
  stepper_->restart();
  if (aim.at_break) return true;
  ++report_.rejected;
  control_.give_up();
  stop_without_step(last);
  return false;
}

/// The state at the step's end with frames of its own; false when it has none, or a force refuses it.
bool ChosenSteps::renew(const Aim& aim, double end, Evaluation& last) {
  next_.y.swap(y_);
  next_.tangent = state_.tangent;
  next_.director = state_.director;
  next_.twist = state_.twist;
  next_.memory = state_.memory;
  next_.rotation = state_.rotation;
  next_.time = aim.time;
  last = system_.rebase(next_, workspace());
  next_.time = end;
  if (last.ok()) last = asks(next_);
  next_.time = aim.time;
  if (last.ok()) std::swap(state_, next_);
  return last.ok();
}

double ChosenSteps::least_step() const {
  return 16 * std::numeric_limits<double>::epsilon() * std::max(std::abs(state_.time), until_ - start_);
}

bool ChosenSteps::reject(const Aim& aim, std::optional<double> error, const Evaluation& why) {
  ++report_.rejected;
  control_.reject(aim.h, error);
  if (control_.step() > least_step()) return true;
  stop_without_step(why);
  return false;
}

void ChosenSteps::stop_without_step(const Evaluation& why) {
  if (why.ok())
    stop(Stop::step_underflow,
         sentence("at time ", state_.time, ": no step above ", least_step(), " meets the tolerance"));
  else
    stop(Stop::not_evaluable,
         sentence("at time ", state_.time, ", ", name_of(why.node), ": ", describe(why.outcome)));
}

void ChosenSteps::accept(const Aim& aim, double error) {
  stepper_->go_on();
  control_.accept(aim.h, error, *stepper_);
  guard_.since().count();
  record(aim);
  // What was learnt before a jump says nothing about what comes after it.
  if (aim.at_break) {
    control_.at_most(aim.h);
    guard_.since().end_at_once();
  }
}

}  // namespace tendril
