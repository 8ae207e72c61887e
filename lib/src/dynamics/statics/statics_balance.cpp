#include <algorithm>
#include <cmath>

#include "dynamics/scene/words.h"
#include "statics_newton.h"

// The last part of the search: no unbalanced force is left, in no direction.
namespace tendril {
namespace {

constexpr int kMostBalancing = 200;          // iterations
constexpr int kIdle = 6;                     // steps in a row that gain neither energy nor balance
constexpr double kShiftOver = 2.0;           // the threshold of a neutral direction
constexpr double kFarthest = 1.0;            // that a node may go in one step, over the longest rod
constexpr int kTightens = 6, kPolishes = 4;  // steps
constexpr double kLeast = 1e-6;              // part of a step

}  // namespace

bool StaticNewton::balanced(const StaticState& at) const {
  return problem_.largest(at.residual) <= problem_.goal(at);
}

/// Some steps without neutral directions, along which rounding would carry the state off. True when they
/// balance it.
bool StaticNewton::tighten(StaticState& at) {
  for (int i = 0; i < kTightens && problem_.conservative(); ++i, ++iterations) {
    Eigen::SparseMatrix<double> k;
    if (!problem_.tangent(at, k).ok()) return false;
    tangent_.set(k, true);
    factored_ = false;
    if (!tangent_.factorise(kShiftOver * least_lift())) return false;
    const Eigen::VectorXd x = -tangent_.solve_but_neutral(at.residual);
    StaticState next;
    if (!x.allFinite() || !try_move(at, x, next)) return false;
    if (!(problem_.largest(next.residual) < 0.5 * problem_.largest(at.residual))) return false;
    last_step_ = size_of(x, at);
    at = std::move(next);
    if (balanced(at)) return true;
  }
  return false;
}

/// Factors the tangent: of a stable search lifted no further than makes it positive, so that directions
/// without resistance are followed, not left out.
bool StaticNewton::stiffen(const StaticState& at) {
  Eigen::SparseMatrix<double> k;
  failure_ = problem_.tangent(at, k);
  if (!failure_.ok()) return false;
  tangent_.set(k, problem_.conservative());
  factored_ = true;
  indefinite_ = cautious_ = false;
  unstable_ = 0;
  const double least = kShiftOver * neutral_threshold(problem_.coordinates(), tangent_);
  if (seeks_stable_) {
    const double before = shift_;
    if (tangent_.factorise(shift_ = least) && tangent_.negative() == 0) return true;
    unstable_ = tangent_.negative();
    shift_ = before;
    return lift(least);
  }
  shift_ = 0.0;
  if (tangent_.factorise(0.0) && !tangent_.soft()) return true;
  return tangent_.factorise(shift_ = least);
}

/// A step to a lower energy, or, where rounding hides it, to a better balance; without an energy by the next
/// step, which must be shorter. False where there is none.
bool StaticNewton::fall_or_contract(StaticState& at, const Step& step) {
  const double unbalanced = problem_.largest(at.residual);
  StaticState next;
  for (double part = step.part; part > kLeast * step.part; part *= 0.5) {
    if (!try_move(at, part * step.x, next)) continue;
    const double gained = at.energy() - next.energy();
    const bool better = problem_.largest(next.residual) < (1.0 - 0.1 * part) * unbalanced;
    const bool lower = seeks_stable_ && (gained > noise(at) || (better && gained > -noise(at)));
    const bool nearer =
        !seeks_stable_ && (better || size_of(solve(next.residual), next) <= (1 - part / 4) * step.size);
    if (!lower && !nearer) continue;
    at = std::move(next);
    return true;
  }
  return false;
}

/// Newton's last steps, while they halve what is unbalanced.
void StaticNewton::polish(StaticState& at) {
  for (int i = 0; i < kPolishes; ++i) {
    const Eigen::VectorXd x = -solve(at.residual);
    last_step_ = size_of(x, at);
    StaticState next;
    if (!try_move(at, x, next) || !(problem_.largest(next.residual) < 0.5 * problem_.largest(at.residual)))
      return;
    at = std::move(next);
  }
}

/// Whether what is left acts along directions that nothing resists: x = -(K + s D)^-1 r, and K takes up
/// little of r.
bool StaticNewton::unheld(const StaticState& at, const Eigen::VectorXd& x) {
  const Eigen::VectorXd& weight = problem_.coordinates().weight();
  const double lifted = shift_ * x.cwiseProduct(weight).dot(x);
  return x.size() > 0 && lifted > 0.5 * std::abs(x.dot(at.residual));
}

StaticNewton::Outcome StaticNewton::fail_to_balance(const StaticState& at, const Eigen::VectorXd& x) {
  Eigen::Index worst = 0;
  const auto size = [&](Eigen::Index k) {
    return std::abs(at.residual[k]) /
           (problem_.coordinates().axis(k) == 3 ? problem_.coordinates().length() : 1.0);
  };
  for (Eigen::Index k = 0; k < at.residual.size(); ++k)
    if (size(k) > size(worst)) worst = k;
  const std::string where =
      sentence(problem_.coordinates().name_of(problem_.coordinates().node(worst)), ", unbalanced by ",
               size(worst), " where ", problem_.goal(at), " counts as balance");
  return unheld(at, x) ? fail(Outcome::unheld, "nothing holds " + where)
                       : fail(Outcome::stalled, "no step balances " + where);
}

/// \param leaving  also what is hardly unstable is left
StaticNewton::Outcome StaticNewton::balance(StaticState& at, bool leaving) {
  Step step;
  int left_here = 0;
  for (int i = 0; i < kMostBalancing; ++i, ++iterations) {
    if (out_of_work()) return fail(Outcome::work_limit, "the work limit");
    if (!stiffen(at))
      return out_of_work()
                 ? fail(Outcome::work_limit, "the work limit")
                 : fail(Outcome::not_evaluable, sentence(problem_.coordinates().name_of(failure_.node), ": ",
                                                         describe(failure_.outcome)));
    if (balanced(at)) {
      const double threshold = kShiftOver * neutral_threshold(problem_.coordinates(), tangent_);
      if (leaving && indefinite_ && left_here++ < kIdle && leave(at, threshold)) continue;
      if (!indefinite_) polish(at);
      return Outcome::found;
    }
    step.x = -solve(at.residual);
    if (!step.x.allFinite()) return fail(Outcome::stalled, "the tangent is singular");
    step.size = last_step_ = size_of(step.x, at);
    const double reach = std::max(problem_.coordinates().reach(at.state, step.x, at.state.time),
                                  problem_.coordinates().norm(step.x) / kFarthest);
    step.part = reach > 1.0 ? 1.0 / reach : 1.0;
    if (!fall_or_contract(at, step)) return fail_to_balance(at, step.x);
  }
  return fail_to_balance(at, step.x);
}

}  // namespace tendril
