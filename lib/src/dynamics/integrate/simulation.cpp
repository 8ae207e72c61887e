#include <tendril/base/error.h>
#include <tendril/dynamics/rod_curves.h>
#include <tendril/dynamics/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controller.h"
#include "dynamics/scene/model.h"
#include "dynamics/scene/words.h"

namespace tendril {
namespace {

void check(const SimulationOptions& options) {
  const auto positive = [](const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      throw InvalidInput(what, std::to_string(value), "a positive number");
  };
  positive("tolerance", options.tolerance);
  positive("energy_limit", options.energy_limit);
  positive("drift_limit", options.drift_limit);
  if (options.fixed_step) positive("fixed_step", *options.fixed_step);
  if (!options.own_stepper && options.fixed_step.has_value() == chooses_steps(options.method))
    throw InvalidInput("fixed_step", options.fixed_step ? "given" : "missing",
                       options.fixed_step
                           ? std::string("none: ") + to_string(options.method) + " chooses its own steps"
                           : std::string("a step for ") + to_string(options.method));
  positive("amplification", options.amplification);
  positive("total_amplification", options.total_amplification);
  if (options.first_step) positive("first_step", *options.first_step);
  if (options.largest_step) positive("largest_step", *options.largest_step);
  if (options.work_limit < 1)
    throw InvalidInput("work_limit", std::to_string(options.work_limit), "at least 1");
  if (options.degree < 1 || options.degree > kMaxDegree)
    throw InvalidInput("degree", std::to_string(options.degree), "1 to " + std::to_string(kMaxDegree));
}

/// A run begins and goes on where the equations can be evaluated: there are frames then, and curves through
/// the masses.
void check_state(const char* name, const System& system, const State& state, System::Workspace& work) {
  const auto nodes = static_cast<std::size_t>(system.node_count());
  const std::size_t bodies = system.body_count();
  const auto size = static_cast<Eigen::Index>(6 * nodes + 2 * system.twist_count() + 12 * bodies + 1);
  if (state.y.size() != size || state.tangent.size() != nodes || state.director.size() != nodes ||
      state.twist.size() != nodes || state.rotation.size() != bodies)
    throw InvalidInput(name, "a state of other sizes", "one made by System::rest_state");
  for (std::size_t b = 0; b < bodies; ++b)
    if (!is_rotation(state.rotation[b]))
      throw InvalidInput(sentence(name, ": rotation[", b, "]"), "not orthonormal, or mirrored",
                         "a rotation to 1e-9");
  Eigen::VectorXd rate;
  const Evaluation at = system.derivative(state, state.time, state.y, rate, work);
  if (at.ok() && state.y.allFinite()) return;
  if (at.outcome == Evaluation::Outcome::refused && state.y.allFinite()) {
    State copy = state;
    system.remember(copy, work);  // the force may know more to say
  }
  throw InvalidInput(sentence(name, ": ", name_of_index(model_of(system), at.node)),
                     describe(at.ok() ? Evaluation::Outcome::not_finite : at.outcome),
                     "a state at which the equations can be evaluated");
}

}  // namespace

const char* to_string(Stop stop) {
  switch (stop) {
    case Stop::finished:
      return "finished";
    case Stop::cancelled:
      return "cancelled";
    case Stop::too_stiff:
      return "too_stiff";
    case Stop::work_limit:
      return "work_limit";
    case Stop::step_underflow:
      return "step_underflow";
    case Stop::not_evaluable:
      return "not_evaluable";
    case Stop::energy_lost:
      return "energy_lost";
    case Stop::energy_gained:
      return "energy_gained";
    case Stop::momentum_lost:
      return "momentum_lost";
  }
  return "unknown";
}

struct Simulation::Implementation {
  Implementation(const System& s, State start, const SimulationOptions& o)
      : system(&s), curves(s, o.degree, o.parametrisation) {
    for (const Anchor& anchor : s.scene().anchors)
      if (std::isfinite(anchor.until)) releases.push_back(anchor.until);
    std::sort(releases.begin(), releases.end());
    const bool released = !releases.empty() && releases.front() <= start.time;
    if (released) system = lay_out(start.time);
    system->remember(start, *system->make_workspace());
    controller = make_controller(*system, std::move(start), o);
    pairs = curves.pairs(*system, controller->state(), controller->workspace());
  }

  const System* lay_out(double from) {
    laid_out.push_back(std::make_unique<const System>(system->scene(), from));
    return laid_out.back().get();
  }

  double next_release() const {
    const auto next = std::upper_bound(releases.begin(), releases.end(), controller->state().time);
    return next == releases.end() ? std::numeric_limits<double>::infinity() : *next;
  }

  /// Frees what lets go at the present time. False when the freed rods have no frames there.
  bool release(double until) {
    State state = controller->state();
    // Of a rod without twist state only one node's director is known, and another one may be asked for.
    const std::vector<Frame> frames = system->frames(state, controller->workspace());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      state.tangent[i] = frames[i].z;
      state.director[i] = frames[i].y;
    }
    // Of what a swivel turned by, its node keeps what is about its tangent.
    const Model& model = model_of(*system);
    for (const Model::Swivel& swivel : model.swivels)
      if (model.anchors[swivel.anchor].until <= state.time)
        state.y[model.spin_begin() + model.twist_index[swivel.node]] *= swivel.axis.z();
    const System* freed = lay_out(state.time);
    if (!freed->rebase(state, *freed->make_workspace()).ok()) return false;
    std::unique_ptr<Controller> next = make_controller(*freed, std::move(state), controller->options());
    next->take_over(controller->past());
    controller = std::move(next);
    system = freed;
    laid_out.erase(laid_out.begin(), laid_out.end() - 1);
    controller->begin(until);
    return true;
  }

  /// One accepted step; what lets go at its end is freed. False when the run has to stop.
  bool step_towards(double target, double until) {
    const double next = next_release();
    fitted = false;
    if (!controller->step_towards(std::min(target, next))) return false;
    if (controller->state().time < next) return true;
    if (release(until)) return true;
    controller->refuse_release();
    return false;
  }

  void fit() {
    if (fitted) return;
    curves.update(*system, controller->state(), controller->workspace(), pairs);
    fitted = true;
  }

  void tell(When when) {
    for (const auto& [follower, its_when] : followers) {
      if (its_when != when) continue;
      fit();
      follower->follow(controller->state().time, pairs);
    }
  }

  void change(const std::function<void(State&)>& how) {
    State state = controller->state();
    how(state);
    if (state.time != controller->state().time)
      throw InvalidInput("change: time", std::to_string(state.time),
                         "that of the state, " + std::to_string(controller->state().time));
    check_state("change", *system, state, controller->workspace());
    if (!system->rebase(state, controller->workspace()).ok())
      throw InvalidInput("change", "a node without a frame", "a state with frames");
    controller->change(std::move(state));
    fitted = false;
    fit();
  }

  std::vector<std::unique_ptr<const System>> laid_out;  ///< the scene after what has let go
  const System* system;
  std::unique_ptr<Controller> controller;
  std::vector<double> releases;  ///< ascending
  RodCurves curves;
  std::vector<CurvePair> pairs;
  bool fitted = true;  ///< the pairs are those of the present state
  std::vector<std::pair<Follower*, When>> followers;
  std::function<bool(double)> progress;
};

Simulation::Simulation(const System& system, State start, const SimulationOptions& options) {
  check(options);
  check_state("start", system, start, *system.make_workspace());
  self_ = std::make_unique<Implementation>(system, std::move(start), options);
}
Simulation::~Simulation() = default;

void Simulation::add(Follower& follower, When when) {
  self_->followers.emplace_back(&follower, when);
}

void Simulation::on_progress(std::function<bool(double time)> progress) {
  self_->progress = std::move(progress);
}

Report Simulation::run(double until, std::span<const double> outputs) {
  const double from = self_->controller->state().time;
  if (!(until >= from) || !std::isfinite(until))
    throw InvalidInput("until", std::to_string(until), "a time not before " + std::to_string(from));
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (!(outputs[i] >= (i > 0 ? outputs[i - 1] : from)) || !(outputs[i] <= until))
      throw InvalidInput("outputs[" + std::to_string(i) + "]", std::to_string(outputs[i]),
                         "ascending times within the run");

  self_->controller->begin(until);
  std::size_t next = 0;
  const auto tell_outputs = [&] {
    bool due = false;
    for (; next < outputs.size() && outputs[next] <= self_->controller->state().time; ++next) due = true;
    if (due) self_->tell(When::output);
  };
  tell_outputs();
  while (self_->controller->running()) {
    const double target = next < outputs.size() ? outputs[next] : until;
    if (!self_->step_towards(target, until)) break;
    self_->tell(When::accepted_step);
    tell_outputs();
    if (self_->progress && !self_->progress(self_->controller->state().time)) self_->controller->cancel();
  }
  self_->fit();
  return self_->controller->report();
}

void Simulation::change(const std::function<void(State&)>& how) {
  self_->change(how);
}

const State& Simulation::state() const {
  return self_->controller->state();
}

std::span<const CurvePair> Simulation::pairs() const {
  return self_->pairs;
}

std::span<const double> Simulation::parameters(std::size_t rod) const {
  return self_->curves.parameters(rod);
}

}  // namespace tendril
