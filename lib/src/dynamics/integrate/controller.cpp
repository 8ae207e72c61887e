#include "controller.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "automatic.h"
#include "chosen_steps.h"
#include "dynamics/scene/model.h"
#include "dynamics/scene/words.h"
#include "fixed_steps.h"

namespace tendril {
namespace {

constexpr long kEnergyInterval = 16;  // accepted steps between looks at the energy balance
constexpr double kTolerated = 2.0;    // tolerances that speeds may be off by

}  // namespace

Controller::Controller(const System& system, State start, const SimulationOptions& options,
                       const Stepper& stepper)
    : system_(system),
      options_(options),
      state_(std::move(start)),
      work_(system.make_workspace()),
      breaks_(system.scene()),
      scale_(system),
      energy_(system, *work_, state_),
      drift_(system, state_),
      until_(state_.time),
      start_(state_.time) {
  for (const auto& force : system_.scene().forces) may_be_refused_ = may_be_refused_ || force->refuses();
  report_.method = stepper.name();
  report_.guard_step = std::numeric_limits<double>::infinity();
  measure_scales();
}

/// Takes the speed that the first acceleration gives over a rod's length. Returns a thousandth of the energy
/// of that.
void Controller::measure_scales() {
  Eigen::VectorXd dy;
  ++other_evaluations_;
  scale_.see(state_);
  if (system_.derivative(state_, state_.time, state_.y, dy, workspace()).ok()) scale_.see_start(dy);
  constexpr double kShare = 2e-3;
  energy_.scale_at_least(kShare * (scale_.energy() + scale_.common_energy()), kShare * scale_.energy());
}

Controller::Past Controller::past() {
  check_energy();
  return {report_, energy_, drift_, scale_.speeds(), start_, evaluations(), {}};
}

void Controller::take_over(const Past& past) {
  const Report mine = std::exchange(report_, past.report);
  report_.method = mine.method;
  report_.guard_step = mine.guard_step;
  energy_.take_over(past.energy);
  drift_.take_over(past.drift);
  other_evaluations_ += past.evaluations;
  start_ = past.start;
  scale_.see(past.speeds);
}

void Controller::begin(double until) {
  until_ = until;
  scale_.begin(until_ - start_);
  scale_.look_ahead(state_.time, until_);
  ended_ = false;
  report_.stop = Stop::finished;
  report_.reason.clear();
}

bool Controller::out_of_work() {
  if (evaluations() < options_.work_limit) return false;
  stop(Stop::work_limit,
       sentence("at time ", state_.time, " the limit of ", options_.work_limit, " evaluations was reached"));
  return true;
}

void Controller::record(const Aim& aim) {
  ++report_.accepted;
  report_.smallest_step = report_.accepted == 1 ? aim.h : std::min(report_.smallest_step, aim.h);
  report_.largest_step = std::max(report_.largest_step, aim.h);
  scale_.see(state_);
  remember();
  if (report_.accepted % kEnergyInterval == 0) check_energy();
}

void Controller::remember() {
  if (system_.remember(state_, workspace())) restart_stepper();
}

void Controller::change(State state) {
  state.y[state.y.size() - 1] = state_.y[state_.y.size() - 1];
  const State before = std::exchange(state_, std::move(state));
  system_.remember(state_, workspace());
  other_evaluations_ += 3;
  report_.changed += energy_.change(before, state_);
  drift_.begin_anew(state_);
  scale_.see(state_);
  begin_anew();
}

void Controller::check_energy() {
  ++other_evaluations_;
  judge(system_.energies(state_, workspace()));
}

/// Speeds may be off by some tolerances of the scale V that steps' errors are measured on. While a motion is
/// much slower than that (it has just begun), this alone is more than a share of its energy: d tolerances
/// change E = m v^2 / 2 by m v d tolerance V = 2 d tolerance sqrt(E E_V). Places may be off as well: a body
/// that lies on another, held by its acceleration a, by d tolerance L, with V^2 at least a L, and so its
/// energy by m a d tolerance L, up to 2 d tolerance E_V.
bool Controller::tolerates(const Energies& energies) const {
  if (!keeps_tolerance()) return false;
  const double at_scale = scale_.energy() + scale_.common_energy();
  return std::abs(energy_.off(state_, energies)) <=
         2.0 * kTolerated * options_.tolerance *
             (std::sqrt(scale_.most_kinetic() * at_scale) + scale_.energy_of_bodies());
}

void Controller::judge(const Energies& energies) {
  // The largest may lie between two looks.
  energy_.scale_at_least(scale_.most_kinetic(), scale_.most_own_kinetic());
  energy_.look(state_, energies);
  const double off = energy_.imbalance();
  const double wrong = may_lose_energy() ? off : std::abs(off);
  if (!ended_ && wrong > std::max(options_.energy_limit, options_.tolerance) && !tolerates(energies))
    stop(off < 0.0 ? Stop::energy_lost : Stop::energy_gained,
         sentence("at time ", state_.time, " the energy is off by ", off, " of the largest seen"));
  if (keeps_tolerance()) judge_drift();
}

/// What is off in energy or angular momentum has moved off in place.
void Controller::judge_drift() {
  drift_.look(state_, energy_.own_imbalance());
  report_.drift = drift_.lag();
  if (ended_ || report_.drift <= options_.drift_limit * options_.tolerance) return;
  const double off = energy_.own_imbalance();
  const std::string so =
      sentence(": the motion is off by about ", report_.drift, " of a length, the limit is ",
               options_.drift_limit, " times the tolerance");
  if (drift_.by_turning())
    stop(Stop::momentum_lost, sentence("at time ", state_.time,
                                       " a body that nothing turns has changed its angular momentum", so));
  else
    stop(off < 0.0 ? Stop::energy_lost : Stop::energy_gained,
         sentence("at time ", state_.time, " the energy of motion is off by ", off, " of the largest seen",
                  so));
}

void Controller::cancel() {
  if (running()) stop(Stop::cancelled, sentence("cancelled at time ", state_.time));
}

void Controller::refuse_release() {
  stop(Stop::not_evaluable, sentence("at time ", state_.time, " what lets go leaves a node without a frame"));
}

void Controller::stop(Stop why, std::string reason) {
  ended_ = true;
  report_.stop = why;
  report_.reason = std::move(reason);
}

std::string Controller::name_of(std::size_t node) const {
  return name_of_index(model_of(system_), node);
}

Evaluation Controller::asks(const State& state) {
  if (!may_be_refused_) return {};
  ++other_evaluations_;
  return system_.refusal(state, workspace());
}

Report Controller::report() {
  check_energy();
  Report result = report_;
  result.time = state_.time;
  result.evaluations = evaluations();
  result.first = energy_.first();
  result.last = energy_.last();
  result.imbalance = energy_.imbalance();
  result.work = energy_.work(state_);
  return result;
}

std::unique_ptr<Controller> make_controller(const System& system, State start,
                                            const SimulationOptions& options) {
  std::unique_ptr<Stepper> stepper =
      options.own_stepper ? options.own_stepper(system) : make_stepper(options.method, system);
  if (!stepper) throw InvalidInput("own_stepper", "it made none", "a stepper");
  if (options.fixed_step)
    return std::make_unique<FixedSteps>(system, std::move(start), options, std::move(stepper));
  auto* embedded = dynamic_cast<EmbeddedStepper*>(stepper.get());
  if (!embedded)
    throw InvalidInput("own_stepper", "it estimates no error", "an EmbeddedStepper, or a fixed_step");
  static_cast<void>(stepper.release());  // to the next one
  std::unique_ptr<EmbeddedStepper> choosing(embedded);
  if (!options.own_stepper && info(options.method).chooses == Chooses::method)
    return std::make_unique<Automatic>(system, std::move(start), options, std::move(choosing));
  return std::make_unique<ChosenSteps>(system, std::move(start), options, std::move(choosing));
}

}  // namespace tendril
