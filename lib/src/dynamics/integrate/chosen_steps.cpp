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
constexpr double kFirst = 0.1, kSeen = 0.5;  // of the shortest period: the first step, and any
constexpr long kPaceInterval = 256;  // accepted implicit steps between looks at what the rest will cost
// Lengths that the energy lost by implicit steps may put a run off at its end, in tolerances.
constexpr double kDriftAim = 2.0;
// For its sake steps' own errors are kept down to this share of the tolerance at most, some six times the
// steps.
constexpr double kFinest = 1e-3;
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr long kWatch = 4;  // explicit steps from look to look at the energy, where they dissipate
// By so much do they get longer or shorter between two.
constexpr double kSafety = 0.9, kShrink = 0.3, kGrow = 2.0;
constexpr long kUnwatched = 16;  // steps without regard to the energy
constexpr double kGross = 0.25;  // of the energy limit, in a step without regard to the energy
constexpr double kStill = 5.0;   // who moves less than that, in lengths over the tolerance, may stop as well
constexpr double kBurst = 0.02;  // of the energy that may still be lost, in one step
// Of the speed that the error scale knows; slower motions have no more to lose.
constexpr double kSlowest = 0.1;

bool keeps_energy(const Model& model) {
  const auto draws = [](const Model::Acting& acting) {
    return !acting.has_energy || acting.force->depends_on_time();
  };
  return !model.damped && std::none_of(model.acting.begin(), model.acting.end(), draws) &&
         std::none_of(model.segments.begin(), model.segments.end(),
                      [](const auto& s) { return s.viscous; }) &&
         std::none_of(model.anchors.begin(), model.anchors.end(),
                      [](const auto& a) { return bool(a.motion); });
}

}  // namespace

ChosenSteps::ChosenSteps(const System& system, State start, const SimulationOptions& options,
                         std::unique_ptr<EmbeddedStepper> stepper)
    : Controller(system, std::move(start), options, *stepper),
      stepper_(std::move(stepper)),
      guard_(system_, options_),
      period_(shortest_period(system.scene())),
      keeps_energy_(keeps_energy(model_of(system))),
      floats_(has_free_body(model_of(system))) {}

void ChosenSteps::begin(double until) {
  Controller::begin(until);
  guard_.since().end_at_once();
  stepper_->go_on();
  const double run = until - state_.time;
  if (!(run > 0.0)) return;
  // Implicit steps do not feel what lets go within them: in the first nothing may move far.
  const double first = std::min({run / 100, kFirst * period_, kFirst * scale_.time_of_a_length()});
  control_.begin(options_.first_step.value_or(first));
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
  guard_.measure(state_, until_ - start_, growth(), workspace());
  report_.largest_frequency = guard_.last_frequency();
  report_.guard_step = guard_.step();
}

Guard::Growth ChosenSteps::growth() const {
  return
      [this](double w, double alpha, double beta, double h) { return stepper_->growth(w, alpha, beta, h); };
}

void ChosenSteps::begin_anew() {
  restart_stepper();
  forget_watch();
  guard_.since().end_at_once();
}

double ChosenSteps::needed() const {
  return explicit_stages() * (until_ - state_.time) / guard_.step();
}

void ChosenSteps::look_ahead() {
  if (stepper_->stiff()) {
    if (floats_ && steps_ == kLongRun && !guard_.frequency()) measure_guard();
    foresee();
    return;
  }
  if (!guard_.since().passed(kGuardInterval)) return;
  measure_guard();
  refuse_where_too_dear();
}

void ChosenSteps::refuse_where_too_dear() {
  if (needed() > left())
    stop(Stop::too_stiff, sentence("at time ", state_.time, " the fastest motion has ",
                                   report_.largest_frequency, " rad per time unit, which caps the step at ",
                                   report_.guard_step, ": the rest of the run would need about ", needed(),
                                   " evaluations and ", left(), " are left"));
}

/// Where no energy leaves, the motion will ask for such steps to its end.
void ChosenSteps::foresee() {
  if (!keeps_energy_ || steps_ % kPaceInterval != 0) return;
  if (pace_ && state_.time > pace_->time) {
    const double rate = static_cast<double>(evaluations() - pace_->evaluations) / (state_.time - pace_->time);
    const double needed = rate * (until_ - state_.time);
    if (needed > 2.0 * left())
      stop(Stop::too_stiff,
           sentence("at time ", state_.time, " implicit steps take ", rate,
                    " evaluations a time unit to keep the energy: the rest of the run would need about ",
                    needed, " and ", left(), " are left"));
  }
  pace_ = Pace{state_.time, evaluations()};
}

/// An implicit step's equations weigh the springs by (h omega)^2 against the masses: their rounding turns and
/// shakes a body that nothing holds in place.
double ChosenSteps::longest_step() const {
  if (!stepper_->stiff()) return std::min({guard_.step(), kSeen * period_, keeping_step_});
  const double w = guard_.frequency().value_or(0.0);
  return std::min(kSeen * period_,
                  floats_ && w > 0.0 ? kLongestPhase / w : std::numeric_limits<double>::infinity());
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
  tolerable_.reset();
  Evaluation last;
  while (!ended_ && !out_of_work()) {
    const Aim at = aim(target);
    const double h = at.seen(state_.time);
    if (!(state_.time + h > state_.time)) return jump(at, last);
    last = stepper_->step(state_, h, y_, error_);
    own_error_ = last.ok() ? scale_.norm(error_, y_, h) / options_.tolerance : kNone;
    double error = last.ok() ? own_error_ : 0.0;
    if (last.ok() && error <= 1.0) error = error_with_energy(at, error);
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

/// What an implicit step may put the balance off by: a share of what the whole run may lose, by its time, or
/// a little of what is left, for a burst.
double ChosenSteps::energy_allowance(double h) const {
  const double run = until_ - start_;
  const double speed = std::max(drift_.fastest(), kSlowest * scale_.rate());
  const double may_lose = 4.0 * kDriftAim * options_.tolerance / std::max(1.0, speed * run) *
                          std::max(energy_.own_scale(), kSlowest * kSlowest * scale_.energy()) *
                          scale_.share_of_flight();
  const double lost = std::abs(watched_ ? watched_->off : energy_.off(state_, energy_.last()));
  const double left = std::max(may_lose - lost, kBurst * may_lose);
  return left * std::max(2.0 * h / (until_ - state_.time), kBurst);
}

/// The state at the step's end is put into next_. Of implicit steps, what the balance is off by counts as an
/// error, too: the estimate does not see how errors add up where every step loses a little.
double ChosenSteps::error_with_energy(const Aim& aim, double error) {
  next_.y.swap(y_);
  next_.tangent = state_.tangent;
  next_.director = state_.director;
  next_.twist = state_.twist;
  next_.memory = state_.memory;
  next_.rotation = state_.rotation;
  next_.time = aim.time;
  next_energies_.reset();
  if (!stepper_->stiff()) {
    watch(aim.h);
    return error;
  }
  ++other_evaluations_;
  next_energies_ = system_.energies(next_, workspace());
  const bool flies = scale_.share_of_flight() < 1.0;
  const bool still = steps_ > kLongRun && drift_.widest() < kStill * options_.tolerance && !flies;
  if (unwatched_ > 0 || still) return std::max(error, gross_error());
  return std::max(error, energy_error(aim, error));
}

/// Explicit steps that dissipate are too cheap to ask for the energy at each: what the balance is off by
/// since it was looked at last says how long the next may be, as a loss a time unit goes with h^5.
void ChosenSteps::watch(double h) {
  if (!stepper_->dissipates() || (watched_ && ++watched_->steps < kWatch)) return;
  ++other_evaluations_;
  const Energies energies = system_.energies(next_, workspace());
  const double off = energy_.off(next_, energies);
  if (watched_) {
    const double ratio = lost_share(energies, off - watched_->off, next_.time - watched_->time);
    keeping_step_ = ratio > 0.0 ? h * std::clamp(kSafety * std::pow(ratio, -0.2), kShrink, kGrow) : kGrow * h;
  }
  watched_ = Watched{next_.time, off, 0};
}

/// Of what may be lost in some time.
double ChosenSteps::lost_share(const Energies& at, double off, double time) const {
  const double rounding = 1e-14 * (at.kinetic + at.elastic + std::abs(at.potential));
  return std::max(0.0, std::abs(off) - rounding) / energy_allowance(time);
}

/// After steps of another kind it has to be asked for.
double ChosenSteps::off_here() {
  if (!watched_ || watched_->time != state_.time) {
    ++other_evaluations_;
    watched_ = Watched{state_.time, energy_.off(state_, system_.energies(state_, workspace())), 0};
  }
  return watched_->off;
}

/// Of a step that is not shortened for the energy's sake: one that ends deep in what none of its stages felt
/// may not use up what the balance may be off by.
double ChosenSteps::gross_error() {
  const double off = std::abs(energy_.off(next_, *next_energies_) - off_here());
  const double most = kGross * std::max(options_.energy_limit, options_.tolerance) * energy_.scale();
  return off > most && most > 0.0 ? off / most : 0.0;
}

double ChosenSteps::energy_error(const Aim& aim, double error) {
  const double off = energy_.off(next_, *next_energies_) - off_here();
  const double ratio = std::min(lost_share(*next_energies_, off, aim.h), error / kFinest);
  if (ratio > 1.0) tolerable_ = std::max(aim.h, tolerable_.value_or(0.0));
  return ratio;
}

/// The state in next_ with frames of its own; false when it has none, or a force refuses it.
bool ChosenSteps::renew(const Aim& aim, double end, Evaluation& last) {
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
  if (why.outcome == Evaluation::Outcome::coupled_too_far) {
    // No shorter step couples less.
    if (turns_from_implicit(why)) return true;
    stop_without_step(why);
    return false;
  }
  control_.reject(aim.h, error);
  // Shorter steps that are worse have begun to see a ringing that longer ones damp: those are taken, and the
  // drift judges.
  if (tolerable_ && aim.h < *tolerable_ && !(own_error_ <= 1.0)) {
    control_.go_on_with(*std::exchange(tolerable_, std::nullopt));
    unwatched_ = kUnwatched;
  }
  if (control_.step() > least_step()) return true;
  stop_without_step(why);
  return false;
}

/// The node whose velocity the last step is most uncertain of; none where there was no step.
std::optional<std::size_t> ChosenSteps::least_certain() const {
  std::optional<std::size_t> node;
  double most = 0.0;
  const auto nodes = static_cast<Eigen::Index>(system_.node_count());
  for (Eigen::Index i = 0; i < nodes && error_.size() >= 6 * nodes; ++i) {
    const double error = error_.segment<3>(3 * (nodes + i)).norm();
    if (error > most) most = error, node = static_cast<std::size_t>(i);
  }
  return node;
}

void ChosenSteps::stop_without_step(const Evaluation& why) {
  if (!why.ok())
    return stop(Stop::not_evaluable,
                sentence("at time ", state_.time, ", ", name_of(why.node), ": ", describe(why.outcome)));
  const std::optional<std::size_t> node = least_certain();
  stop(Stop::step_underflow,
       sentence("at time ", state_.time, ": no step above ", least_step(), " meets the tolerance",
                node ? "; the error is largest at " + name_of(*node) : std::string()));
}

void ChosenSteps::accept(const Aim& aim, double error) {
  stepper_->go_on();
  ++steps_;
  control_.accept(aim.h, error, *stepper_);
  if (unwatched_ > 0) --unwatched_;
  guard_.since().count();
  if (next_energies_) {
    judge(*next_energies_);
    watched_ = Watched{state_.time, energy_.off(state_, *next_energies_), 0};
  }
  record(aim);
  // What was learnt before a jump says nothing about what comes after it.
  if (aim.at_break) {
    control_.at_most(aim.h);
    guard_.since().end_at_once();
  }
}

}  // namespace tendril
