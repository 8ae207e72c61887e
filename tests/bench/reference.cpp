#include <cmath>

#include "bench/contest.h"
#include "bench/output.h"

namespace tendril::bench {
namespace {

/// Whether a run would take longer than the budget, judged by a twentieth of it.
bool hopeless(const Solver& solver, const Problem& problem, double tolerance, double budget) {
  const Trial probe = solver.run(problem, tolerance, budget / 20);
  return probe.capped && probe.reached * 60 < problem.duration;  // multistep methods start slowly
}

/// The run at the tightest tolerance, from 1e-4 on, that the budget allows.
std::optional<Trial> tightest(const Solver& solver, const Problem& problem, const Effort& effort) {
  std::optional<Trial> best;
  const double budget = effort.seconds;
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    if (tolerance < 0.99 * effort.tolerance) break;
    if (hopeless(solver, problem, tolerance, budget)) break;
    Trial trial = solver.run(problem, tolerance, budget);
    if (!trial.done()) break;
    const double seconds = trial.seconds;
    best = std::move(trial);
    if (2.0 * seconds > budget) break;
  }
  return best;
}

std::string name(const Solver& solver, const Trial& trial) {
  return solver.name + " at " + text("%.0e", trial.tolerance);
}

/// Second opinions, cheapest first.
std::vector<Solver> others() {
  std::vector<Solver> out{own_solvers()[0]};
  for (const Solver& solver : sundials_solvers())
    if (solver.name != "ARKODE CK") out.push_back(solver);
  return out;
}

}  // namespace

std::optional<Reference> make_reference(const Problem& problem, const Effort& effort) {
  const Solver rodas = own_solvers()[1];
  const std::optional<Trial> one = tightest(rodas, problem, effort);
  if (!one) return std::nullopt;
  Reference best{one->p, INFINITY, name(rodas, *one) + " alone", false};
  const auto consider = [&](const Eigen::VectorXd& p, const std::string& its_name) {
    const double gap = distance(problem, one->p, p);
    if (gap < best.gap) best = {one->p, gap, name(rodas, *one) + " and " + its_name, true};
    return best.gap < effort.gap;
  };
  for (const Solver& solver : others()) {
    const std::optional<Trial> other = tightest(solver, problem, effort);
    if (other && consider(other->p, name(solver, *other))) return best;
  }
  if (const std::optional<Extrapolated> euler = extrapolated_euler(problem, effort.seconds))
    consider(euler->p, "extrapolated Euler in up to " + std::to_string(euler->steps) + " steps");
  return best;
}

}  // namespace tendril::bench
