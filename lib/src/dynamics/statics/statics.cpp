#include <tendril/base/error.h>
#include <tendril/dynamics/statics.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/scene/model.h"
#include "dynamics/scene/words.h"
#include "statics_newton.h"

namespace tendril {
namespace {

constexpr double kReach = 0.6;         // of a predicted step, in units of what one step may do
constexpr double kMostPoseTurn = 1.5;  // of an anchor in one step [rad]
constexpr double kShortest = 1e-7;     // step, as a share of the path
constexpr double kTooWild = 1e-6;      // step that only a wrong prediction asks for
constexpr double kShortestToBranch = 1e-6;
constexpr int kBranches = 2;  // directions that may become unstable in one step
constexpr int kAny = std::numeric_limits<int>::max();
constexpr int kFew = 4, kMany = 9;  // iterations that ask for longer and shorter steps

void check(const State& start, const StaticsOptions& options) {
  const auto positive = [](const char* name, double value, double most) {
    if (!(value > 0.0 && value <= most))
      throw InvalidInput(name, sentence(value), sentence("a positive number up to ", most));
  };
  positive("tolerance", options.tolerance, 1e-3);
  positive("largest_step", options.largest_step, 1.0);
  positive("work_limit", static_cast<double>(options.work_limit), 1e15);
  for (const double load : {options.first_load.value_or(0.0), options.last_load})
    if (!std::isfinite(load)) throw InvalidInput("load", sentence(load), "a finite share");
  if (options.until && !(std::isfinite(*options.until) && *options.until >= start.time))
    throw InvalidInput("until", sentence(*options.until), sentence("a time from ", start.time, " on"));
}

/// A straight path of load and time, followed from 0 to 1.
struct LoadPath {
  double load, time, by_load, by_time;
};

/// Stability of a state; `unbalanced` as for analyse().
Stability stability_at(const System& system, const State& state, double load, double unbalanced) {
  StaticProblem problem(system);
  StaticState at;
  at.state = state;
  at.load = load;
  Eigen::SparseMatrix<double> k;
  if (!problem.conservative()) return {.kind = Stability::Kind::not_judged};
  if (!problem.evaluate(at).ok() || !problem.tangent(at, k).ok()) return {};
  StaticTangent tangent(problem.coordinates().weight());
  tangent.set(k, true);
  return analyse(problem.coordinates(), tangent, unbalanced);
}

class Search {
 public:
  Search(const System& system, const StaticsOptions& options)
      : system_(system), options_(options), problem_(system), newton_(problem_, options_) {}

  Equilibrium run(State start);

 private:
  bool start_at(State start);
  void take(StaticState next);
  bool first();
  bool settle();
  bool go(const LoadPath& path, double begin, double part);
  bool step(const LoadPath& path, double& done, double& h);
  double capped(const LoadPath& path, double done, double h, const Eigen::VectorXd& rate) const;
  double pose_turn(double from, double to) const;
  void stop(Balance balance, const std::string& why);
  void stop(StaticNewton::Outcome outcome, const std::string& why);
  void report();

  double unbalanced() const;

  const System& system_;
  const StaticsOptions& options_;
  StaticProblem problem_;
  StaticNewton newton_;
  System::WorkspacePtr work_ = system_.make_workspace();
  StaticState at_;
  int unstable_ = 0;  ///< directions, at the state reached
  Equilibrium out_;
};

double Search::unbalanced() const {
  return static_cast<double>(problem_.coordinates().size()) * problem_.largest(at_.residual) *
         problem_.coordinates().length();
}

void Search::stop(Balance balance, const std::string& why) {
  out_.balance = balance;
  out_.reason = sentence("at load ", at_.load, " and time ", at_.state.time, ": ", why);
}

void Search::stop(StaticNewton::Outcome outcome, const std::string& why) {
  const Balance balance = outcome == StaticNewton::Outcome::work_limit      ? Balance::work_limit
                          : outcome == StaticNewton::Outcome::unheld        ? Balance::unheld
                          : outcome == StaticNewton::Outcome::not_evaluable ? Balance::not_evaluable
                                                                            : Balance::stalled;
  stop(balance, why);
}

/// Forces remember every equilibrium on the way, as they do accepted steps: what a contact may pass, and
/// where it sticks, is about the last one.
void Search::take(StaticState next) {
  at_ = std::move(next);
  system_.remember(at_.state, *work_);
}

bool Search::start_at(State start) {
  at_.state = std::move(start);
  system_.remember(at_.state, *work_);
  const bool bends = problem_.coordinates().energy_scale() > 0.0;
  at_.load = options_.first_load.value_or(bends ? 0.0 : options_.last_load);
  const Evaluation e = problem_.evaluate(at_);
  if (!e.ok())
    stop(Balance::not_evaluable, problem_.coordinates().name_of(e.node) + ": " + describe(e.outcome));
  return e.ok();
}

bool Search::first() {
  StaticState next = at_;
  const StaticNewton::Outcome outcome = newton_.find(next, kAny);
  if (outcome != StaticNewton::Outcome::found) {
    stop(outcome, newton_.reason());
    return false;
  }
  take(std::move(next));
  ++out_.steps;
  return true;
}

/// What is hardly unstable or neutral on the way need not be where it ends.
bool Search::settle() {
  StaticState next = at_;
  const StaticNewton::Outcome outcome = newton_.settle(next);
  if (outcome != StaticNewton::Outcome::found) {
    stop(outcome, newton_.reason());
    return false;
  }
  take(std::move(next));
  return true;
}

double Search::pose_turn(double from, double to) const {
  double fastest = 0.0;
  for (const Anchor& anchor : model_of(system_).anchors) {
    if (!anchor.motion || !anchor.holds_frame) continue;
    for (const double share : {0.0, 0.5, 1.0})
      fastest = std::max(fastest, anchor.motion(from + share * (to - from)).angular_velocity.norm());
  }
  return fastest * (to - from);
}

/// The step h cut so that what it is predicted to turn and stretch stays small.
double Search::capped(const LoadPath& path, double done, double h, const Eigen::VectorXd& rate) const {
  for (int i = 0; i < 60; ++i, h /= 2) {
    const double from = at_.state.time;
    const double to = path.time + (done + h) * path.by_time;
    if (pose_turn(from, to) > kMostPoseTurn) continue;
    if (problem_.coordinates().reach(at_.state, h * rate, to) <= kReach) return h;
  }
  return h;
}

bool Search::step(const LoadPath& path, double& done, double& h) {
  Eigen::VectorXd rate;
  const Evaluation e = problem_.drift(at_, path.by_load, path.by_time, rate);
  Eigen::VectorXd x = e.ok() ? newton_.follow(at_, rate) : Eigen::VectorXd{};
  if (x.size() == 0) x = Eigen::VectorXd::Zero(problem_.size());
  const double most = std::min(h, 1.0 - done);
  h = capped(path, done, most, x);
  if (h < kTooWild) {
    x.setZero();
    h = capped(path, done, most, x);
  }
  StaticNewton::Outcome outcome = StaticNewton::Outcome::not_evaluable;
  std::string why = "the next step would turn or stretch edges too far, however short";
  for (; h > std::min(kShortest, 0.5 * (1.0 - done)); h /= 4) {
    // The last step ends exactly where it should.
    const double s = done + h > 1.0 - 1e-12 ? 1.0 : done + h;
    StaticState next;
    const Evaluation moved =
        problem_.move(at_, h * x, path.time + s * path.by_time, path.load + s * path.by_load, next);
    if (!moved.ok()) {
      outcome = StaticNewton::Outcome::not_evaluable;
      why = problem_.coordinates().name_of(moved.node) + ": " + describe(moved.outcome);
      continue;
    }
    // Past several bifurcations at once the branch taken would be a matter of chance.
    outcome = newton_.find(next, h > kShortestToBranch ? unstable_ + kBranches : kAny);
    why = newton_.reason();
    if (outcome == StaticNewton::Outcome::work_limit || outcome == StaticNewton::Outcome::unheld) break;
    if (outcome != StaticNewton::Outcome::found) continue;
    take(std::move(next));
    unstable_ = newton_.unstable();
    done = s;
    ++out_.steps;
    const int iterations = newton_.last_iterations();
    h *= iterations <= kFew ? 2.0 : iterations >= kMany ? 0.5 : 1.0;
    h = std::min(h, options_.largest_step);
    return true;
  }
  stop(outcome, why);
  return false;
}

/// \param begin, part  of all paths, for the progress
bool Search::go(const LoadPath& path, double begin, double part) {
  double h = options_.largest_step;
  for (double done = 0.0; done < 1.0;) {
    if (!step(path, done, h)) return false;
    if (options_.progress && !options_.progress(begin + part * done)) {
      stop(Balance::cancelled, "cancelled");
      return false;
    }
  }
  return true;
}

void Search::report() {
  out_.load = at_.load;
  out_.conservative = problem_.conservative();
  out_.last_step = newton_.last_step();
  out_.elastic = at_.elastic;
  out_.potential = at_.load * at_.potential;
  out_.force_scale = problem_.force_scale(at_);
  out_.residual = out_.force_scale > 0.0 ? problem_.largest(at_.residual) / out_.force_scale : 0.0;
  for (const Support& support : problem_.supports(at_)) {
    out_.support.push_back(support.force);
    out_.torque.push_back(support.torque);
  }
  out_.stability = stability_at(system_, at_.state, at_.load, unbalanced());
  out_.iterations = newton_.iterations;
  out_.factorisations = newton_.tangent().factorisations;
  out_.left = newton_.left;
  out_.state = std::move(at_.state);
}

Equilibrium Search::run(State start) {
  const double begin = start.time;
  const double time = options_.until.value_or(begin) - begin;
  if (!start_at(start)) {
    out_.state = std::move(start);
    return out_;
  }
  const double load = options_.last_load - at_.load;
  const bool loads = load != 0.0 && !system_.scene().forces.empty();
  const double part = !loads ? 0.0 : time > 0.0 ? 0.5 : 1.0;
  bool found = first();
  if (found && loads) found = go({at_.load, begin, load, 0.0}, 0.0, part);
  at_.load = found && !loads ? options_.last_load : at_.load;
  if (found && time > 0.0) found = go({at_.load, begin, 0.0, time}, part, 1.0 - part);
  if (found) settle();
  report();
  return out_;
}

}  // namespace

const char* to_string(Balance balance) {
  switch (balance) {
    case Balance::converged:
      return "converged";
    case Balance::stalled:
      return "stalled";
    case Balance::work_limit:
      return "work_limit";
    case Balance::unheld:
      return "unheld";
    case Balance::not_evaluable:
      return "not_evaluable";
    case Balance::cancelled:
      return "cancelled";
  }
  return "";
}

const char* to_string(Stability::Kind kind) {
  switch (kind) {
    case Stability::Kind::stable:
      return "stable";
    case Stability::Kind::neutral:
      return "neutral";
    case Stability::Kind::unstable:
      return "unstable";
    case Stability::Kind::not_judged:
      return "not judged";
  }
  return "";
}

Equilibrium find_equilibrium(const System& system, State start, const StaticsOptions& options) {
  check(start, options);
  return Search(system, options).run(std::move(start));
}

Stability stability_of(const System& system, const State& state, double load) {
  return stability_at(system, state, load, 0.0);
}

}  // namespace tendril
