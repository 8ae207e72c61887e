#include <tendril/dynamics/simulation.h>

#include "bench/clock.h"
#include "bench/contest.h"

namespace tendril::bench {
namespace {

std::string path_of(const Report& report) {
  std::string out;
  for (const Switch& entry : report.switches) out += (out.empty() ? "" : " > ") + entry.to;
  return out;
}

Trial run(Method method, const Problem& problem, double tolerance, double cap) {
  SimulationOptions options;
  options.method = method;
  options.tolerance = tolerance;
  // Explicit steps are run up to the cap instead of refusing, so that their time can be extrapolated.
  if (method == Method::cash_karp || method == Method::nystrom) options.work_limit = 1'000'000'000'000;
  Trial out;
  out.tolerance = tolerance;
  const double begin = cpu_seconds();
  Simulation simulation(problem.system, problem.start, options);
  Deadline deadline(cap);
  simulation.on_progress([&](double) { return !deadline.passed(); });
  const Report report = simulation.run(problem.duration);
  out.seconds = cpu_seconds() - begin;
  out.reached = report.time;
  out.steps = report.accepted;
  out.evaluations = report.evaluations;
  out.p = simulation.state().y.head(3 * static_cast<Eigen::Index>(problem.system.node_count()));
  out.capped = report.stop == Stop::cancelled;
  out.path = path_of(report);
  if (report.stop != Stop::finished && !out.capped)
    out.failure = std::string(tendril::to_string(report.stop)) + ": " + report.reason;
  return out;
}

}  // namespace

std::vector<Solver> own_solvers() {
  std::vector<Solver> out;
  for (const auto& [name, method] : {std::pair("Cash-Karp", Method::cash_karp),
                                     {"RODAS", Method::rodas},
                                     {"automatic", Method::automatic},
                                     {"Nystrom", Method::nystrom}})
    out.push_back({name, [m = method](const Problem& problem, double tolerance, double cap) {
                     return run(m, problem, tolerance, cap);
                   }});
  return out;
}

double distance(const Problem& problem, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / std::sqrt(static_cast<double>(a.size()) / 3.0) / problem.length;
}

}  // namespace tendril::bench
