#include <cmath>

#include "bench/sections.h"

namespace tendril::bench {
namespace {

constexpr double kGoal = 1e-3;

/// How a method did on a problem: the fastest of its runs that met the goal, or how long one would take.
struct Score {
  std::string solver;
  std::optional<Trial> best;    ///< met the goal, or was capped
  double error = NAN;           ///< of that run; not known when capped
  double seconds = INFINITY;    ///< to the end, extrapolated when capped
  std::string remark;           ///< refusals, and wrong ends reported as success
  double per_evaluation = NAN;  ///< seconds, of the last run
  std::string last_kind;        ///< of the remarks
  bool met() const { return best && best->done(); }
};

/// Adds to the remarks; the same kind at several tolerances in a row is said once.
void remark(Score& score, const std::string& kind, double tolerance, const std::string& detail) {
  std::string& last = score.last_kind;
  if (kind == last) {
    const std::size_t to = score.remark.rfind(" to 1e");
    if (to != std::string::npos && to > score.remark.rfind(';') + 1) score.remark.erase(to);
    score.remark += " to " + text("%.0e", tolerance);
    return;
  }
  last = kind;
  score.remark += (score.remark.empty() ? "" : "; ") + kind + detail + " at " + text("%.0e", tolerance);
}

Trial repeated(const Solver& solver, const Problem& problem, double tolerance, double cap) {
  Trial best = solver.run(problem, tolerance, cap);
  const int more = !best.done() ? 0 : best.seconds < 0.05 ? 4 : best.seconds < 0.3 ? 2 : 0;
  for (int i = 0; i < more; ++i)
    best.seconds = std::min(best.seconds, solver.run(problem, tolerance, cap).seconds);
  return best;
}

/// Takes a trial into account.
/// \return  whether a tighter tolerance is still worth a try
bool take(const Problem& problem, const Reference& reference, Trial trial, Score& score) {
  score.per_evaluation = trial.seconds / static_cast<double>(trial.evaluations);
  if (!trial.failure.empty()) {
    const std::size_t end = std::min(trial.failure.find(':'), trial.failure.find(','));
    remark(score, trial.failure.substr(0, end), trial.tolerance, "");
    return trial.evaluations > 0;
  }
  if (trial.capped) {
    const double needed = trial.seconds * problem.duration / std::max(trial.reached, 1e-12);
    if (!score.best) score.seconds = needed, score.best = std::move(trial);
    return false;
  }
  const double error = distance(problem, trial.p, reference.p);
  if (error > 100 * trial.tolerance) remark(score, "WRONG", trial.tolerance, " by " + text("%.1e", error));
  if (!(error <= kGoal)) return true;
  const bool first = !score.met();
  if (trial.seconds < score.seconds) {
    score.seconds = trial.seconds;
    score.error = error;
    score.best = std::move(trial);
  }
  return first;
}

Score compete(const Problem& problem, const Reference& reference, const Solver& solver, double cap) {
  Score score;
  score.solver = solver.name;
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
    if (!take(problem, reference, repeated(solver, problem, tolerance, cap), score)) break;
  if (score.best && !score.best->path.empty() && solver.name == "automatic")
    score.remark += (score.remark.empty() ? "" : "; ") + score.best->path;
  return score;
}

OrderedJson to_json(const Score& score) {
  OrderedJson out{{"solver", score.solver}, {"remark", score.remark}};
  if (!score.best) return out;
  out["tolerance"] = score.best->tolerance;
  out["seconds"] = score.seconds;
  out["extrapolated"] = score.best->capped;
  out["error"] = std::isfinite(score.error) ? OrderedJson(score.error) : OrderedJson();
  out["steps"] = score.best->steps;
  out["evaluations"] = score.best->evaluations;
  return out;
}

std::string seconds_of(const Score& score) {
  return score.best ? (score.best->capped ? "~" : "") + duration(score.seconds) : "-";
}

const Score& named(const std::vector<Score>& scores, const std::string& solver) {
  for (const Score& score : scores)
    if (score.solver == solver) return score;
  static const Score none;
  return none;
}

double best_of_own(const std::vector<Score>& scores) {
  return std::min({scores[0].seconds, scores[1].seconds, scores[2].seconds, scores[3].seconds});
}

void print_scores(const std::vector<Score>& scores) {
  Table table({"", "time to 1e-3", "x our best", "tolerance", "error", "steps", "evaluations", "remark"});
  const double ours = best_of_own(scores);
  for (const Score& score : scores) {
    if (!score.best) {
      table.row({"  " + score.solver, "-", "", "", "", "", "", score.remark});
      continue;
    }
    table.row({"  " + score.solver, seconds_of(score), text("%.2f", score.seconds / ours),
               text("%.0e", score.best->tolerance), score.met() ? text("%.1e", score.error) : "?",
               std::to_string(score.best->steps), std::to_string(score.best->evaluations), score.remark});
  }
  table.print();
}

/// What must hold on any machine.
void check(const Problem& problem, const Reference& reference, const std::vector<Score>& scores,
           std::vector<std::string>& broken) {
  if (!reference.independent || !(reference.gap < 0.1 * kGoal))
    broken.push_back(problem.name + ": reference not certified: " + reference.by + ", gap " +
                     text("%.1e", reference.gap));
  for (std::size_t k = 0; k < 4; ++k)
    if (scores[k].remark.find("WRONG") != std::string::npos)
      broken.push_back(problem.name + ": " + scores[k].solver + ": " + scores[k].remark);
  for (const char* implicit : {"RODAS", "automatic"})
    if (!named(scores, implicit).best)
      broken.push_back(problem.name + ": " + implicit +
                       " never met the goal: " + named(scores, implicit).remark);
}

Effort effort_for(const Problem& problem, bool quick) {
  if (quick) return {3.0, 1e-6, 0.05 * kGoal};
  return {problem.system.node_count() > 500 ? 40.0 : 20.0, 1e-8, 0.05 * kGoal};
}

struct Row {
  std::string problem;
  std::vector<Score> scores;
};

OrderedJson measure(const Problem& problem, Settings& settings, std::vector<Row>& rows) {
  OrderedJson out{{"problem", problem.name}};
  const std::optional<Reference> reference = make_reference(problem, effort_for(problem, settings.quick));
  if (!reference) {
    settings.broken.push_back(problem.name + ": no reference");
    return out;
  }
  std::vector<Solver> solvers = own_solvers();
  for (auto&& more : {odeint_solvers(), sundials_solvers()})
    solvers.insert(solvers.end(), more.begin(), more.end());
  Row row{problem.name, {}};
  for (const Solver& solver : solvers)
    row.scores.push_back(compete(problem, *reference, solver, settings.quick ? 0.2 : 2.5));
  std::printf("\n%s; reference %s, gap %.1e%s\n", problem.name.c_str(), reference->by.c_str(), reference->gap,
              reference->independent ? "" : " (NOT independent)");
  print_scores(row.scores);
  check(problem, *reference, row.scores, settings.broken);
  out["reference"] = {
      {"by", reference->by}, {"gap", reference->gap}, {"independent", reference->independent}};
  for (const Score& score : row.scores) out["scores"].push_back(to_json(score));
  rows.push_back(std::move(row));
  return out;
}

/// One line a problem, as a reader compares them.
void print_overview(const std::vector<Row>& rows) {
  if (rows.empty()) return;
  std::vector<std::string> headings{"problem"};
  for (const Score& score : rows[0].scores) headings.push_back(score.solver);
  for (const char* more : {"auto/best (1.3)", "CK/odeint per RHS (1)"}) headings.emplace_back(more);
  Table table(headings);
  for (const Row& row : rows) {
    std::vector<std::string> cells{row.problem};
    for (const Score& score : row.scores) cells.push_back(seconds_of(score));
    const double best = std::min({row.scores[0].seconds, row.scores[1].seconds, row.scores[3].seconds});
    cells.push_back(text("%.2f", row.scores[2].seconds / best));
    const double odeint = named(row.scores, "odeint CK54").per_evaluation;
    cells.push_back(text("%.2f", row.scores[0].per_evaluation / odeint));
    table.row(cells);
  }
  std::printf("\n");
  table.print();
}

std::vector<Cantilever> problems(bool quick) {
  std::vector<Cantilever> out;
  for (const int nodes : {32, 128, 1024})
    for (const double young : {1e4, 1e6, 1e8, 1e10}) {
      const bool short_enough = nodes == 32 ? young < 1e9 : nodes == 128 && young == 1e6;
      if (!quick || short_enough) out.push_back({nodes, young});
    }
  for (const double beta : {1e-4, 1e-2})
    if (!quick || beta == 1e-4) out.push_back({64, 1e6, beta});
  for (const double ratio : {1e3, 1e6})
    if (!quick) out.push_back({64, 1e6, 0.0, ratio});
  return out;
}

}  // namespace

OrderedJson stiff_rods(Settings& settings) {
  heading(
      "One second of a clamped rod to 1e-3 of its length",
      "best of tolerances 1e-2 to 1e-7 that ends within 1e-3 L (RMS of the nodes) of a reference by two "
      "methods; ~: "
      "extrapolated from a capped run, error unknown; WRONG: success reported, error above 100 tolerances");
  OrderedJson out = OrderedJson::array();
  std::vector<Row> rows;
  for (const Cantilever& what : problems(settings.quick))
    out.push_back(measure(cantilever(what), settings, rows));
  print_overview(rows);
  return out;
}

}  // namespace tendril::bench
