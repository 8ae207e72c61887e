#include "controller.h"

#include <tendril/base/error.h>
#include <tendril/dynamics/stability.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/scene/free_bodies.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

constexpr double kSafety = 0.93;  // thesis 3.34
constexpr double kStiffSafety = 0.85;
constexpr double kShrink = 0.2;  // bounds of the factor
constexpr double kGrow = 5.0;
constexpr double kLeastError = 1e-2;   // that a prediction counts with, of the tolerance
constexpr double kLongestPhase = 1e5;  // of the fastest motion in an implicit step: rounding grows to 1e-6
constexpr long kLongRun = 32;          // accepted implicit steps after which that is asked
constexpr long kGuardInterval = 128;   // accepted steps between estimates of the largest frequency
constexpr long kDue = 1'000'000'000;   // a count of steps past every interval
constexpr int kLanczosVectors = 16;
constexpr long kEnergyInterval = 16;  // accepted steps between looks at the energy balance

}  // namespace

Controller::Controller(const System& system, State start, const SimulationOptions& options)
    : system_(system), options_(options), state_(std::move(start)), work_(system.make_workspace()) {
  for (const Rod& rod : system.scene().rods) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < rod.p.size(); ++i) length += (rod.p[i + 1] - rod.p[i]).norm();
    rod_length_.push_back(length);
    longest_ = std::max(longest_, length);
    // A mass much lighter than the rod's others may ring fast and carry next to nothing: its speed counts by
    // the root of what it carries, its place in full.
    double mass = 0.0;
    for (const double m : rod.mass) mass += m;
    for (const double m : rod.mass)
      speed_share_.push_back(
          mass > 0.0 ? std::clamp(std::sqrt(2.0 * m * static_cast<double>(rod.mass.size()) / mass), 0.01, 1.0)
                     : 1.0);
  }
  for (const auto& force : system.scene().forces)
    for (const double time : force->breaks()) breaks_.push_back(time);
  std::sort(breaks_.begin(), breaks_.end());
  floats_ = has_free_body(model_of(system));
  make_steppers();
  report_.method = fixed_ ? fixed_->name() : embedded_->name();
  report_.guard_step = std::numeric_limits<double>::infinity();
  measure_scales();
  now_ = report_.first = system_.energies(state_, workspace());
  start_ = state_.time;
  report_.work = -state_.y[state_.y.size() - 1];  // counted from here
}

Controller::Controller(const System& system, State state, Controller& before)
    : Controller(system, std::move(state), before.options_) {
  before.check_energy();
  const double released = now_.total() - before.now_.total();
  const Report mine = std::exchange(report_, before.report_);
  report_.method = mine.method;
  report_.guard_step = mine.guard_step;
  report_.work += released;
  other_evaluations_ += before.evaluations();
  start_ = before.start_;
  h_ = before.h_;
  speed_ = std::max(speed_, before.speed_);
  energy_scale_ = std::max(energy_scale_, before.energy_scale_);
}

void Controller::make_steppers() {
  std::unique_ptr<Stepper> stepper =
      options_.own_stepper ? options_.own_stepper(system_) : make_stepper(options_.method, system_);
  if (!stepper) throw InvalidInput("own_stepper", "it made none", "a stepper");
  if (options_.fixed_step) {
    fixed_ = std::move(stepper);
    return;
  }
  auto* embedded = dynamic_cast<EmbeddedStepper*>(stepper.get());
  if (!embedded)
    throw InvalidInput("own_stepper", "it estimates no error", "an EmbeddedStepper, or a fixed_step");
  stepper.release();
  embedded_.reset(embedded);
}

bool Controller::automatic() const {
  return options_.method == Method::automatic && !options_.own_stepper;
}

void Controller::measure_scales() {
  Eigen::VectorXd dy;
  ++other_evaluations_;
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  double moved = 0.0;
  double mass = 0.0;
  if (system_.derivative(state_, state_.time, state_.y, dy, workspace()).ok()) {
    Eigen::Index i = 0;
    for (const Rod& rod : system_.scene().rods)
      for (const double m : rod.mass) {
        moved += m * dy.segment<3>(3 * n + 3 * i).norm();
        mass += m;
        ++i;
      }
  }
  take_speed();
  if (mass > 0.0) speed_ = std::max(speed_, std::sqrt(moved / mass * longest_));
  energy_scale_ = 1e-3 * mass * speed_ * speed_;
}

void Controller::begin(double until) {
  until_ = until;
  ended_ = false;
  report_.stop = Stop::finished;
  report_.reason.clear();
  since_guard_ = kDue;
  if (embedded_) embedded_->restart();
  const double run = until - state_.time;
  if (h_ == 0.0) h_ = options_.first_step.value_or(run / 100);
}

void Controller::measure_guard() {
  since_guard_ = 0;
  other_evaluations_ += 2L * kLanczosVectors;
  const double frequency = system_.largest_frequency(state_, kLanczosVectors, workspace());
  report_.largest_frequency = frequency;
  if (std::abs(frequency - guard_frequency_) > 0.01 * guard_frequency_) {
    guard_frequency_ = frequency;
    double alpha = std::numeric_limits<double>::infinity();
    double beta = alpha;
    double most_beta = 0.0;
    for (const Rod& rod : system_.scene().rods) {
      alpha = std::min(alpha, rod.mass_damping);
      beta = std::min(beta, rod.viscosity);
      most_beta = std::max(most_beta, rod.viscosity);
    }
    const GuardLimits limits{options_.amplification, options_.total_amplification, until_ - start_};
    // Where rods differ, the least damped decides on growth and the most viscous on the real axis.
    report_.guard_step =
        std::min(guard_step(frequency, alpha, beta, limits), guard_step(frequency, alpha, most_beta, limits));
  }
}

void Controller::guard() {
  measure_guard();
  const double needed = 6.0 * (until_ - state_.time) / report_.guard_step;
  const double left = static_cast<double>(options_.work_limit - evaluations());
  if (needed > left)
    stop(Stop::too_stiff,
         sentence("at time ", state_.time, " the fastest motion has ", report_.largest_frequency,
                  " rad per time unit, which caps the step at ", report_.guard_step,
                  ": the rest of the run would need about ", needed, " evaluations and ", left, " are left"));
}

bool Controller::cut_at_break(double& target) const {
  const auto next = std::upper_bound(breaks_.begin(), breaks_.end(), state_.time);
  const bool break_first = next != breaks_.end() && *next <= target;
  if (break_first) target = *next;
  return break_first;
}

/// An implicit step's equations weigh the springs by (h omega)^2 against the masses: their rounding turns and
/// shakes a body that nothing holds in place.
double Controller::longest_step() const {
  if (!embedded_->stiff()) return report_.guard_step;
  return floats_ && guard_frequency_ > 0.0 ? kLongestPhase / guard_frequency_
                                           : std::numeric_limits<double>::infinity();
}

Controller::Aim Controller::aim(double target) const {
  const double cap = longest_step();
  double h = std::min({h_, cap, options_.largest_step.value_or(until_ - start_)});
  const bool break_first = cut_at_break(target);
  const double left = target - state_.time;
  if (h >= left * (1.0 - 1e-10)) return {left, target, break_first};
  // Two equal steps rather than one and a crumb.
  if (2.0 * h > left) h = 0.5 * left;
  return {h, state_.time + h, false};
}

/// Before a jump the stages must not see what comes after it: the step ends just before.
double Controller::seen(const Aim& aim) const {
  return aim.at_break ? std::nextafter(aim.time, state_.time) - state_.time : aim.h;
}

bool Controller::out_of_work() {
  if (evaluations() < options_.work_limit) return false;
  stop(Stop::work_limit,
       sentence("at time ", state_.time, " the limit of ", options_.work_limit, " evaluations was reached"));
  return true;
}

bool Controller::step_towards(double target) {
  if (fixed_) return fixed_step_towards(target);
  if (automatic())
    choose();
  else if (!embedded_->stiff() && since_guard_ >= kGuardInterval)
    guard();
  else if (embedded_->stiff() && floats_ && report_.accepted == kLongRun && guard_frequency_ < 0.0)
    measure_guard();
  Evaluation last;
  while (!ended_ && !out_of_work()) {
    const Aim at = aim(target);
    const double h = seen(at);
    if (!(state_.time + h > state_.time)) {
      // Nothing between here and the jump.
      state_.time = at.time;
      embedded_->restart();
      if (at.at_break) return true;
      return reject(at, 0.0, last);
    }
    last = embedded_->step(state_, h, y_, error_);
    const double error = last.ok() ? error_norm(error_) : 0.0;
    if (last.ok() && error <= 1.0) {
      next_.y.swap(y_);
      next_.tangent = state_.tangent;
      next_.director = state_.director;
      next_.twist = state_.twist;
      next_.time = at.time;
      last = system_.rebase(next_, workspace());
      if (last.ok()) {
        std::swap(state_, next_);
        accept(at, error);
        return !ended_;
      }
    }
    const double factor = last.ok() ? std::max(kShrink, kSafety * std::pow(error, -0.25)) : kShrink;
    if (!reject(at, factor, last)) break;
  }
  return false;
}

bool Controller::reject(const Aim& aim, double factor, const Evaluation& why) {
  ++report_.rejected;
  rejected_ = true;
  h_ = aim.h * factor;
  const double least =
      16 * std::numeric_limits<double>::epsilon() * std::max(std::abs(state_.time), until_ - start_);
  if (h_ > least) return true;
  if (why.ok())
    stop(Stop::step_underflow,
         sentence("at time ", state_.time, ": no step above ", least, " meets the tolerance"));
  else
    stop(Stop::not_evaluable,
         sentence("at time ", state_.time, ", ", place(why.node), ": ", describe(why.outcome)));
  return false;
}

void Controller::accept(const Aim& aim, double error) {
  embedded_->restart();
  const double grow = -1.0 / (embedded_->error_order() + 1);  // -0.2 for Cash-Karp
  const double safety = embedded_->stiff() ? kStiffSafety : kSafety;
  double wish = error > 0.0 ? safety * std::pow(error, grow) : kGrow;
  if (embedded_->stiff()) {
    // Gustafsson's predictive control: how the error changed from step to step tells what it will do next.
    // Without it every third step or so of a ringing rod is tried in vain. After a step tried in vain the two
    // steps are too unlike to tell anything.
    const double e = std::max(error, kLeastError);
    const bool rejected = std::exchange(rejected_, false);
    if (rejected)
      wish = std::min(wish, 1.0);
    else if (last_error_ > 0.0)
      wish = std::min(
          wish, std::max(kShrink, safety * std::pow(last_error_ / (e * e), -grow) * aim.h / last_step_));
    last_error_ = e;
    last_step_ = aim.h;
  }
  const double factor = std::min(kGrow, wish);
  wished_ = aim.h * wish;
  // A step cut short by an output says little about the next one.
  const bool cut = aim.h < 0.99 * h_;
  h_ = cut ? std::max(h_ * std::min(factor, 1.0), aim.h * factor) : aim.h * factor;
  record(aim);
  // What was learnt before a jump says nothing about what comes after it.
  if (aim.at_break) {
    h_ = std::min(h_, aim.h);
    since_guard_ = kDue;
  }
}

void Controller::record(const Aim& aim) {
  ++report_.accepted;
  ++since_guard_;
  report_.smallest_step = report_.accepted == 1 ? aim.h : std::min(report_.smallest_step, aim.h);
  report_.largest_step = std::max(report_.largest_step, aim.h);
  take_speed();
  if (report_.accepted % kEnergyInterval == 0) check_energy();
}

void Controller::take_speed() {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double share = speed_share_[static_cast<std::size_t>(i)];
    fastest = std::max(fastest, share * share * state_.y.segment<3>(3 * n + 3 * i).squaredNorm());
  }
  speed_ = std::max(speed_, std::sqrt(fastest));
}

double Controller::error_norm(const Eigen::VectorXd& error) const {
  const auto n = static_cast<Eigen::Index>(system_.node_count());
  const auto m = static_cast<Eigen::Index>(system_.twist_count());
  const double speed = speed_ > 0.0 ? speed_ : longest_;
  double largest = 0.0;
  for (std::size_t r = 0; r < rod_length_.size(); ++r) {
    const auto first = 3 * static_cast<Eigen::Index>(system_.rods()[r].first);
    const auto count = 3 * static_cast<Eigen::Index>(system_.rods()[r].count);
    largest = std::max(largest, error.segment(first, count).cwiseAbs().maxCoeff() / rod_length_[r]);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    largest = std::max(largest, speed_share_[static_cast<std::size_t>(i)] *
                                    error.segment<3>(3 * n + 3 * i).cwiseAbs().maxCoeff() / speed);
  if (m > 0) {
    largest = std::max(largest, error.segment(6 * n, m).cwiseAbs().maxCoeff());
    largest = std::max(largest, error.segment(6 * n + m, m).cwiseAbs().maxCoeff() * longest_ / speed);
  }
  return largest / options_.tolerance;
}

double Controller::imbalance() const {
  const double work = state_.y[state_.y.size() - 1] + report_.work;
  return energy_scale_ > 0.0 ? (now_.total() - report_.first.total() - work) / energy_scale_ : 0.0;
}

void Controller::check_energy() {
  now_ = system_.energies(state_, workspace());
  ++other_evaluations_;
  const double work = state_.y[state_.y.size() - 1] + report_.work;
  energy_scale_ =
      std::max(energy_scale_, now_.kinetic + std::abs(now_.elastic - report_.first.elastic) +
                                  std::abs(now_.potential - report_.first.potential) + std::abs(work));
  const double off = imbalance();
  // A stiff method takes energy out of what it does not resolve; none may put energy in.
  const double wrong = embedded_ && embedded_->stiff() ? off : std::abs(off);
  if (!ended_ && wrong > std::max(options_.energy_limit, options_.tolerance))
    stop(Stop::energy_lost,
         sentence("at time ", state_.time, " the energy is off by ", off, " of the largest seen"));
}

void Controller::cancel() {
  if (!ended_ && state_.time < until_) stop(Stop::cancelled, sentence("cancelled at time ", state_.time));
}

void Controller::refuse_release() {
  stop(Stop::not_evaluable, sentence("at time ", state_.time, " what lets go leaves a node without a frame"));
}

void Controller::stop(Stop why, std::string reason) {
  ended_ = true;
  report_.stop = why;
  report_.reason = std::move(reason);
}

std::string Controller::place(std::size_t node) const {
  std::size_t rod = 0;
  while (rod + 1 < system_.rods().size() && node >= system_.rods()[rod + 1].first) ++rod;
  return sentence("rod ", rod, " node ", node - system_.rods()[rod].first);
}

Report Controller::report() {
  check_energy();
  Report result = report_;
  result.time = state_.time;
  result.evaluations = evaluations();
  result.last = now_;
  result.imbalance = imbalance();
  result.work = state_.y[state_.y.size() - 1] + report_.work;
  return result;
}

}  // namespace tendril
