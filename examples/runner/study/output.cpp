#include "study/output.h"

#include "study/svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tendril::runner {
namespace {

using svg::number;

OrderedJson finite_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson();
}

OrderedJson to_json(const Setting& setting) {
  return {{"method", tendril::to_string(setting.method)},
          {setting.by_step() ? "fixed_step" : "tolerance", setting.value}};
}

bool below_gap(const Trial& trial, const Results& results) {
  return trial.error && results.reference && std::isfinite(results.reference->gap.position) &&
         trial.error->position < results.reference->gap.position;
}

/// The stability of its steps costs more than their accuracy.
bool held_by_guard(const Trial& trial) {
  const double mean = trial.report.time / static_cast<double>(std::max(1L, trial.report.accepted));
  return (trial.report.method == "Cash-Karp 4(5)" || trial.report.method == "Nystrom 5(3)") &&
         mean > 0.5 * trial.report.guard_step;
}

OrderedJson to_json(const Trial& trial, const Results& results) {
  OrderedJson out = to_json(trial.setting);
  out["outcome"] = to_string(trial.outcome);
  out["reason"] = trial.reason;
  out["integrator"] = trial.report.method;
  out["cpu_s"] = trial.cpu;
  out["evaluations"] = trial.evaluations;
  out["extrapolated"] = trial.outcome == Trial::Outcome::capped;
  out["steps_accepted"] = trial.report.accepted;
  out["steps_rejected"] = trial.report.rejected;
  out["position_error"] = trial.error ? OrderedJson(trial.error->position) : OrderedJson();
  out["director_error"] = trial.error ? OrderedJson(trial.error->director) : OrderedJson();
  out["below_gap"] = below_gap(trial, results);
  out["held_by_guard"] = held_by_guard(trial);
  out["energy_imbalance"] = finite_or_null(trial.report.imbalance);
  out["switches"] = OrderedJson::array();
  for (const Switch& entry : trial.report.switches)
    out["switches"].push_back({{"time", entry.time}, {"to", entry.to}, {"reason", entry.reason}});
  return out;
}

OrderedJson to_json(const Reference& reference) {
  return {{"certified", reference.certified},
          {"statement", reference.statement},
          {"first", to_json(reference.first.setting)},
          {"second", to_json(reference.second.setting)},
          {"position_gap", finite_or_null(reference.gap.position)},
          {"director_gap", finite_or_null(reference.gap.director)}};
}

/// \param before  the line above, whose reason is not said again
std::string line_of(const Trial& trial, const Trial* before, const Results& results) {
  const bool capped = trial.outcome == Trial::Outcome::capped;
  char text[256];
  std::string error = "-", director = "-";
  if (trial.error) {
    const char* mark = below_gap(trial, results) ? "<" : capped ? ">" : "";
    error = mark + number("%.1e", below_gap(trial, results) ? results.reference->gap.position
                                                            : trial.error->position);
    director = number("%.1e", trial.error->director);
  }
  const bool ran = trial.finished() || capped;
  const std::string mark = capped ? "~" : "";
  std::snprintf(text, sizeof text, "%-26s %9s %9s %10s %11s %9s  ", to_string(trial.setting).c_str(),
                error.c_str(), director.c_str(), ran ? (mark + number("%.3g s", trial.cpu)).c_str() : "-",
                ran ? (mark + number("%.3g", trial.evaluations)).c_str() : "-",
                trial.finished() ? number("%.1e", trial.report.imbalance).c_str() : "-");
  std::string out = text;
  const bool again = before != nullptr && before->reason == trial.reason && !trial.reason.empty();
  if (again) return out + to_string(trial.outcome) + " likewise\n";
  if (!trial.finished()) return out + to_string(trial.outcome) + ": " + trial.reason + "\n";
  if (held_by_guard(trial)) out += "steps held by the guard; ";
  if (trial.setting.method == Method::automatic) {
    for (const Switch& entry : trial.report.switches)
      out += (&entry == &trial.report.switches.front() ? "" : ", then ") + entry.to;
  }
  return out + "\n";
}

}  // namespace

std::string error_definition(const Results& results) {
  return "largest over the outputs of the root mean square distance of the masses from the reference, "
         "relative to the "
         "longest curve-pair (" +
         shortest(results.length) + "); the same of the angle between frames, in radians";
}

OrderedJson to_json(const Results& results, const Study& study) {
  OrderedJson out;
  out["scene"] = study.file().path;
  out["duration"] = study.file().duration;
  out["masses"] = study.system().node_count();
  out["twist_states"] = study.system().twist_count();
  out["length"] = results.length;
  out["error"] = error_definition(results);
  out["target"] = results.plan.target;
  if (results.plan.rate) out["evaluations_per_second"] = *results.plan.rate;
  out["reference"] = results.reference ? to_json(*results.reference) : OrderedJson();
  out["runs"] = OrderedJson::array();
  for (const Trial& trial : results.trials) out["runs"].push_back(to_json(trial, results));
  out["orders"] = OrderedJson::array();
  for (const Order& order : results.orders) {
    out["orders"].push_back({{"method", tendril::to_string(order.method)},
                             {"of", chooses_steps(order.method) ? "tolerance" : "fixed_step"},
                             {"order", order.order}});
  }
  out["recommended"] = results.advice.setting ? to_json(*results.advice.setting) : OrderedJson();
  out["recommendation"] = results.advice.sentence;
  return out;
}

std::string to_table(const Results& results, const Study& study) {
  std::string out =
      study.file().path + ": " + std::to_string(study.system().node_count()) + " masses, " +
      shortest(study.file().duration) + " time units\nerror: " + error_definition(results) + "\nreference " +
      (results.reference ? results.reference->statement : "missing: no run finished in its time") + "\n\n";
  char text[256];
  std::snprintf(text, sizeof text, "%-26s %9s %9s %10s %11s %9s\n", "run", "error", "angle",
                results.plan.rate ? "counted" : "CPU", "evaluations", "energy");
  out += text;
  for (const Trial& trial : results.trials)
    out += line_of(trial, &trial == &results.trials.front() ? nullptr : &trial - 1, results);
  out +=
      "~ extrapolated, > of the part that was run, < below what the reference resolves; energy: imbalance "
      "over the "
      "largest energy\n";
  for (const Order& order : results.orders)
    out += std::string(tendril::to_string(order.method)) + ": error falls with the " +
           (chooses_steps(order.method) ? "tolerance" : "step") + " to the power " +
           number("%.2f", order.order) + "\n";
  return out + "\n" + results.advice.sentence + "\n";
}

}  // namespace tendril::runner
