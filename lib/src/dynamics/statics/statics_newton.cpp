#include "statics_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dynamics/scene/words.h"

namespace tendril {
namespace {

constexpr int kMostDescending = 300;  // iterations down the energy
constexpr int kMostNear = 30;         // of them near an equilibrium, which balance() finds better
constexpr int kMostContracting = 25;  // iterations along a branch
constexpr int kUphill = 5;            // steps in a row that may lie above the lowest energy
constexpr double kChord = 0.05;       // size of a step from which its tangent serves again
constexpr double kContraction = 0.2;  // at least, of steps by a tangent that served before
constexpr int kMostChords = 8;
constexpr double kNear = 1e-4;        // size of a step from which Newton's method must contract
constexpr double kNearSaddle = 1e-6;  // size of a step at which an unstable equilibrium counts as reached
constexpr double kNoise = 1e-13;      // of an energy, over its parts
constexpr double kLeastShift = 2.0;   // of a tangent, over the threshold of a neutral direction
constexpr double kHardly = 1e-4;      // of a negative eigenvalue, over B / l
constexpr int kSlow = 3;              // steps near an equilibrium that do not shrink
constexpr double kKick = 0.02;        // of what one step may do, off an unstable equilibrium
constexpr double kLeastPart = 1e-3;   // of a step

}  // namespace

StaticNewton::StaticNewton(StaticProblem& problem, const StaticsOptions& options)
    : problem_(problem),
      options_(options),
      tangent_(problem.coordinates().weight()),
      seeks_stable_(options.seek == StaticsOptions::Seek::stable && problem.conservative()) {}

StaticNewton::Outcome StaticNewton::fail(Outcome outcome, std::string reason) {
  reason_ = std::move(reason);
  return outcome;
}

bool StaticNewton::out_of_work() {
  return tangent_.factorisations >= options_.work_limit;
}

double StaticNewton::noise(const StaticState& at) const {
  return kNoise * (at.elastic + std::abs(at.load * at.potential) + problem_.coordinates().energy_scale());
}

double StaticNewton::least_lift() const {
  return std::max(neutral_threshold(problem_.coordinates(), tangent_),
                  kHardly * problem_.coordinates().energy_scale());
}

/// Raises the shift until the tangent is positive; the next one begins lower.
bool StaticNewton::lift(double least) {
  for (shift_ = std::max(8 * least, shift_ / 16); !out_of_work(); shift_ *= 4)
    if (tangent_.factorise(shift_) && tangent_.negative() == 0) return indefinite_ = true;
  return false;
}

bool StaticNewton::factorise(const StaticState& at) {
  Eigen::SparseMatrix<double> k;
  failure_ = problem_.tangent(at, k);
  if (!failure_.ok()) return false;
  tangent_.set(k, problem_.conservative());
  factored_ = tangent_.finite();
  if (!factored_) {
    failure_ = {Evaluation::Outcome::not_finite, 0};
    return false;
  }
  indefinite_ = false;
  unstable_ = 0;
  if (!problem_.conservative()) {
    // What no spring resists only rounding turns; the shift keeps that small and hardly slows the rest.
    shift_ = 0.0;
    return tangent_.factorise(kLeastShift * neutral_threshold(problem_.coordinates(), tangent_));
  }
  if (!cautious_ && tangent_.factorise(0.0) && (!seeks_stable_ || tangent_.negative() == 0)) {
    unstable_ = tangent_.negative();
    shift_ = 0.0;
    if (!tangent_.soft()) return true;
  }
  // What is hardly unstable is left alone: nothing tells it from rounding or a neutral turn.
  const double least = least_lift();
  const bool passed = tangent_.factorise(2 * least);
  const int deep = passed ? tangent_.negative() : 1;
  cautious_ = passed && (!seeks_stable_ || deep == 0);
  unstable_ = deep;
  return cautious_ || (seeks_stable_ && lift(least));
}

Eigen::VectorXd StaticNewton::solve(const Eigen::VectorXd& b) const {
  return cautious_ ? tangent_.solve_but_neutral(b) : tangent_.solve(b);
}

double StaticNewton::size_of(const Eigen::VectorXd& x, const StaticState& at) const {
  const double size = problem_.coordinates().norm(x);
  const double scale = problem_.coordinates().energy_scale();
  // Along a nearly neutral direction rounding makes long steps that gain next to nothing.
  return scale > 0.0 ? std::min(size, std::sqrt(std::abs(x.dot(at.residual)) / scale)) : size;
}

bool StaticNewton::plan(const StaticState& at, Step& step) {
  if (!factorise(at)) return false;
  step.x = -solve(at.residual);
  if (!step.x.allFinite()) {
    failure_ = {Evaluation::Outcome::not_finite, 0};
    return false;
  }
  step.size = size_of(step.x, at);
  const double reach = problem_.coordinates().reach(at.state, step.x, at.state.time);
  step.part = reach > limit_ ? limit_ / reach : 1.0;
  return true;
}

bool StaticNewton::try_move(const StaticState& from, const Eigen::VectorXd& x, StaticState& to) {
  failure_ = problem_.move(from, x, from.state.time, from.load, to);
  return failure_.ok();
}

StaticNewton::Outcome StaticNewton::find(StaticState& at, int most_unstable) {
  most_unstable_ = most_unstable;
  last_step_ = 0.0;
  last_iterations_ = 0;
  limit_ = 1.0;
  reason_.clear();
  if (problem_.size() == 0) return Outcome::found;
  if (factored_ && shift_ == 0.0) {
    // The tangent of the equilibrium before knows the tensions better than that of a predicted state.
    Step step;
    step.x = -solve(at.residual);
    step.size = step.x.allFinite() ? size_of(step.x, at) : kChord;
    if (step.size < kChord) chords(at, step);
  }
  // Off a branch's own neutral directions steps stay short; down the energy each state tells anew.
  cautious_ = cautious_ && !seeks_stable_;
  const Outcome outcome = approach(at);
  if (outcome == Outcome::found && balanced(at)) return outcome;
  if (outcome != Outcome::found) {
    if (outcome != Outcome::stalled) return outcome;
    if (!seeks_stable_) return without_resistance(at);
    at = best_;
  }
  if (tighten(at)) return Outcome::found;
  const bool cautious = cautious_;
  const Outcome last = balance(at, false);
  // The next step's prediction keeps to what this one knew of neutral directions.
  factored_ = factored_ && !cautious;
  cautious_ = cautious;
  return last;
}

/// Why a search along a branch stalled: along what nothing resists, steps are as long as rounding makes them.
StaticNewton::Outcome StaticNewton::without_resistance(const StaticState& at) {
  if (balanced(at)) return Outcome::found;
  Eigen::SparseMatrix<double> k;
  if (!problem_.tangent(at, k).ok()) return Outcome::stalled;
  tangent_.set(k, false);
  factored_ = false;
  shift_ = kLeastShift * neutral_threshold(problem_.coordinates(), tangent_);
  if (!tangent_.factorise(shift_)) return Outcome::stalled;
  const Eigen::VectorXd x = -solve(at.residual);
  return x.allFinite() && unheld(at, x) ? fail_to_balance(at, x) : Outcome::stalled;
}

StaticNewton::Outcome StaticNewton::settle(StaticState& at) {
  if (problem_.size() == 0 || !seeks_stable_) return Outcome::found;
  return balance(at, true);
}

StaticNewton::Outcome StaticNewton::approach(StaticState& at) {
  return seeks_stable_ ? descend(at) : contract(at);
}

/// A whole step that changes the energy by less than its rounding.
bool StaticNewton::gains_nothing(const StaticState& at, const Step& step) const {
  return step.part == 1.0 && std::abs(step.x.dot(at.residual)) < noise(at);
}

/// One step under the watch of the energy: some steps may lie above the lowest one seen, since turning an
/// edge past its neighbours' turns stretches it for one step; then back to that one, with shorter steps.
bool StaticNewton::take_downhill(StaticState& at, const Step& step) {
  StaticState next;
  bool moved = try_move(at, step.part * step.x, next);
  if (moved && next.energy() <= best_.energy() + noise(best_)) {
    at = best_ = std::move(next);
    uphill_ = 0;
    limit_ = std::min(1.0, 2 * limit_);
    return true;
  }
  if (moved && ++uphill_ < kUphill) {
    at = std::move(next);
    return true;
  }
  at = best_;
  uphill_ = 0;
  limit_ /= 4;
  return limit_ > 1e-12;
}

StaticNewton::Outcome StaticNewton::descend(StaticState& at) {
  best_ = at;
  uphill_ = 0;
  double before = std::numeric_limits<double>::infinity();
  int slow = 0, near = 0;
  for (; last_iterations_ < kMostDescending; ++last_iterations_, ++iterations) {
    if (out_of_work()) return fail(Outcome::work_limit, "the work limit");
    Step step;
    if (!plan(at, step))
      return out_of_work()
                 ? fail(Outcome::work_limit, "the work limit")
                 : fail(Outcome::not_evaluable, sentence(problem_.coordinates().name_of(failure_.node), ": ",
                                                         describe(failure_.outcome)));
    last_step_ = step.size;
    if (last_iterations_ == 0 && unstable_ > most_unstable_)
      return fail(Outcome::too_unstable, sentence(unstable_, " unstable directions at once"));
    if (indefinite_ && step.size < kNearSaddle && leave(at, least_lift())) continue;
    if (step.part == 1.0 && step.size <= options_.tolerance) {
      StaticState next;
      if (try_move(at, step.x, next)) at = std::move(next);
      return Outcome::found;
    }
    near += step.size < kNear ? 1 : 0;
    if (near > kMostNear) return fail(Outcome::stalled, sentence("the last step of size ", step.size));
    slow = step.size < kNear && step.size > 0.8 * before && !indefinite_ ? slow + 1 : slow;
    cautious_ = cautious_ || slow > 0;
    if (slow > kSlow && step.part == 1.0 && std::abs(step.x.dot(at.residual)) < noise(at))
      return Outcome::found;
    if (slow > 3 * kSlow)
      return fail(Outcome::stalled, sentence("the step no longer shrinks below ", step.size, ": rounding"));
    before = std::min(before, step.size);
    const bool whole = step.part == 1.0 && !indefinite_;
    if (whole && step.size < kChord && chords(at, step)) return Outcome::found;
    if (!take_downhill(at, step))
      return fail(Outcome::stalled, sentence("no step from one of size ", step.size, " lowers the energy"));
  }
  return fail(Outcome::stalled,
              sentence("not converged in ", kMostDescending, " iterations, the last of size ", last_step_));
}

/// Steps by the tangent at hand while they shrink well. True when the next is within the tolerance; else
/// `step` is the next.
bool StaticNewton::chords(StaticState& at, Step& step) {
  StaticState next;
  for (int i = 0; i < kMostChords && step.size > options_.tolerance; ++i, ++iterations) {
    if (!try_move(at, step.x, next)) return false;
    const Eigen::VectorXd x = -solve(next.residual);
    const double size = size_of(x, next);
    if (!(size <= kContraction * step.size || size <= options_.tolerance)) return false;
    at = std::move(next);
    step.x = x;
    last_step_ = step.size = size;
  }
  return step.size <= options_.tolerance;
}

/// From amplitude on along +x or -x, whichever is lower, as long as the energy falls.
bool StaticNewton::fall(const StaticState& at, double amplitude, const Eigen::VectorXd& x,
                        StaticState& lowest) {
  StaticState next;
  double sign = 1.0;
  if (!try_move(at, -amplitude * x, next)) return false;
  const double behind = next.energy();
  if (!try_move(at, amplitude * x, next)) return false;
  if (behind < next.energy() - 1e-6 * std::abs(at.energy() - next.energy()) - noise(at)) sign = -1.0;
  for (; amplitude <= 1.0; amplitude *= 2) {
    if (!try_move(at, sign * amplitude * x, next) || !(next.energy() < lowest.energy() - noise(at))) break;
    lowest = next;
  }
  return lowest.energy() < at.energy() - noise(at);
}

/// Off an unstable equilibrium along its lowest mode, as far as the energy falls.
bool StaticNewton::leave(StaticState& at, double threshold) {
  LowestMode mode = lowest_mode(tangent_, threshold);
  factored_ = false;
  if (!(mode.value < -threshold)) return false;
  const double most = mode.x.cwiseAbs().maxCoeff();
  for (const double x : mode.x)
    if (std::abs(x) > 0.9 * most) {
      mode.x *= x > 0.0 ? 1.0 : -1.0;
      break;
    }
  mode.x /= problem_.coordinates().reach(at.state, mode.x, at.state.time);
  // Just past a bifurcation the energy falls only over a short length.
  StaticState lowest = at;
  for (double amplitude = kKick; amplitude > 1e-4 * kKick && !fall(at, amplitude, mode.x, lowest);)
    amplitude /= 4;
  if (!(lowest.energy() < at.energy() - noise(at))) return false;
  at = best_ = lowest;
  uphill_ = 0;
  ++left;
  return true;
}

/// Newton's method with the test of natural monotonicity [Deuflhard 2004]: the next step by the same tangent
/// must be shorter.
StaticNewton::Outcome StaticNewton::contract(StaticState& at) {
  double before = std::numeric_limits<double>::infinity();
  int slow = 0;
  for (; last_iterations_ < kMostContracting; ++last_iterations_, ++iterations) {
    if (out_of_work()) return fail(Outcome::work_limit, "the work limit");
    Step step;
    if (!plan(at, step))
      return fail(Outcome::not_evaluable,
                  sentence(problem_.coordinates().name_of(failure_.node), ": ", describe(failure_.outcome)));
    last_step_ = step.size;
    StaticState next;
    const bool last = step.part == 1.0 && step.size <= options_.tolerance;
    bool shorter = false;
    for (double part = step.part; part > kLeastPart * step.part && !shorter; part *= last ? 0.0 : 0.5)
      shorter =
          try_move(at, part * step.x, next) &&
          (last || step.size < kNear || size_of(solve(next.residual), next) <= (1 - part / 4) * step.size);
    if (!shorter) return fail(Outcome::stalled, sentence("no part of a step of size ", step.size, " helps"));
    at = std::move(next);
    if (last) return Outcome::found;
    slow = step.size < kNear && step.size > 0.8 * before ? slow + 1 : 0;
    cautious_ = problem_.conservative() && (cautious_ || slow > 0);
    if (slow > kSlow && gains_nothing(at, step)) return Outcome::found;
    if (slow > 3 * kSlow)
      return fail(Outcome::stalled, sentence("the step no longer shrinks below ", step.size, ": rounding"));
    before = std::min(before, step.size);
  }
  return fail(Outcome::stalled,
              sentence("not converged in ", kMostContracting, " iterations, the last of size ", last_step_));
}

Eigen::VectorXd StaticNewton::follow(const StaticState& at, const Eigen::VectorXd& rate) {
  if (problem_.size() == 0) return {};
  // The last tangent is that at the equilibrium or next to it, unless it was shifted.
  if ((!factored_ || shift_ > 0.0) && !factorise(at)) return {};
  Eigen::VectorXd x = -solve(rate);
  return x.allFinite() ? x : Eigen::VectorXd{};
}

}  // namespace tendril
