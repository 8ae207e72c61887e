#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "controller.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

constexpr int kLanczosVectors = 16;
// Accepted steps between estimates of the largest frequency: a twentieth of the cheapest method's work.
constexpr long kGuardInterval = 640;

/// Beyond which a run is refused. Of a stepper of one's own nothing is known; of a method that amplifies
/// every oscillation the energy tells.
StabilityLimits limits_of(const SimulationOptions& options) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  if (options.own_stepper || info(options.method).stability.oscillation == 0.0) return {kAny, kAny};
  return info(options.method).stability;
}

}  // namespace

void Controller::guard_fixed_step() {
  since_guard_ = 0;
  other_evaluations_ += 2L * kLanczosVectors;
  const double w = system_.largest_frequency(state_, kLanczosVectors, workspace());
  report_.largest_frequency = w;
  double decay = 0.0;
  for (const Rod& rod : system_.scene().rods)
    decay = std::max(decay, rod.mass_damping + rod.viscosity * w * w);
  const StabilityLimits limits = limits_of(options_);
  report_.guard_step = std::min(limits.oscillation / w, limits.decay / decay);
  if (*options_.fixed_step >= report_.guard_step)
    stop(Stop::too_stiff,
         sentence("at time ", state_.time, " the fastest motion has ", w,
                  " rad per time unit and decays with ", decay, ": ", report_.method, " needs steps below ",
                  report_.guard_step, ", and the fixed step is ", *options_.fixed_step));
}

Controller::Aim Controller::fixed_aim(double target) const {
  const bool break_first = cut_at_break(target);
  const double left = target - state_.time;
  const double count = std::ceil(left / *options_.fixed_step - 1e-9);
  if (count <= 1.0) return {left, target, break_first};
  return {left / count, state_.time + left / count, false};
}

bool Controller::fixed_step_towards(double target) {
  if (since_guard_ >= kGuardInterval) guard_fixed_step();
  if (ended_ || out_of_work()) return false;
  const Aim at = fixed_aim(target);
  if (!(at.time > state_.time)) {
    stop(Stop::step_underflow, sentence("at time ", state_.time, " a step of ", at.h, " moves no clock"));
    return false;
  }
  const double h = seen(at);
  if (state_.time + h > state_.time) {
    next_ = state_;
    const Evaluation result = fixed_->advance(next_, h);
    if (!result.ok()) {
      const bool placed = result.outcome != Evaluation::Outcome::not_converged;
      stop(Stop::not_evaluable, sentence("at time ", state_.time, placed ? ", " + place(result.node) : "",
                                         ": ", describe(result.outcome)));
      return false;
    }
    std::swap(state_, next_);
  }
  state_.time = at.time;
  if (at.at_break) fixed_->restart();
  record(at);
  return !ended_;
}

}  // namespace tendril
