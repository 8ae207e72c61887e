#include <cmath>

#include "bench/contest.h"
#include "bench/output.h"

namespace tendril::bench {
namespace {

/// Whether a run would take longer than the budget, judged by a twentieth of it.
bool hopeless(const Solver& solver, const Problem& problem, double tolerance, double budget) {
  const Trial probe = solver.run(problem, tolerance, budget / 20);
  return probe.capped && probe.reached * 20 < problem.duration;
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

}  // namespace

std::optional<Reference> make_reference(const Problem& problem, const Effort& effort) {
  const std::vector<Solver> own = own_solvers();
  const Solver &cash_karp = own[0], &rodas = own[1];
  std::optional<Trial> implicit = tightest(rodas, problem, effort);
  std::vector<Solver> others{cash_karp};
  for (const Solver& solver : sundials_solvers())
    if (solver.name != "ARKODE CK") others.push_back(solver);
  for (const Solver& solver : others) {
    const std::optional<Trial> other = tightest(solver, problem, effort);
    if (!other) continue;
    if (!implicit) return Reference{other->p, INFINITY, name(solver, *other) + " alone", false};
    const double gap = distance(problem, implicit->p, other->p);
    return Reference{implicit->p, gap, name(rodas, *implicit) + " and " + name(solver, *other), true};
  }
  if (!implicit) return std::nullopt;
  const Trial loose = rodas.run(problem, 10 * implicit->tolerance, effort.seconds);
  return Reference{implicit->p, distance(problem, implicit->p, loose.p),
                   name(rodas, *implicit) + " and " + text("%.0e", loose.tolerance), false};
}

}  // namespace tendril::bench
