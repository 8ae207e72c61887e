#include "commands.h"
#include "study/output.h"
#include "write/folder.h"
#include "write/interrupt.h"
#include "write/progress.h"

#include <tendril/base/file.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace tendril::runner {
namespace {

struct ReportArguments {
  std::string scene, out;
  std::vector<std::string> methods;
  std::vector<double> tolerances{1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
  std::vector<double> steps;
  double budget = 60.0, target = 1e-3;
  std::optional<double> cap, rate;
  bool json = false;
};

Method method_of(const std::string& name) {
  if (const MethodInfo* row = find_method(name)) return row->method;
  std::string known;
  for (const MethodInfo& row : methods()) known += std::string(known.empty() ? "" : ", ") + row.name;
  throw InvalidInput("--methods", name, "some of " + known);
}

/// Methods of order 1 are comparators and only run when they are asked for.
std::vector<Method> methods_for(const ReportArguments& options) {
  std::vector<Method> out;
  for (const std::string& name : options.methods) out.push_back(method_of(name));
  if (!out.empty()) return out;
  for (const MethodInfo& row : methods())
    if (row.order > 1) out.push_back(row.method);
  return out;
}

void check(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) throw InvalidInput(name, shortest(value), "a positive number");
}

Plan plan_for(const ReportArguments& options) {
  Plan out;
  out.methods = methods_for(options);
  out.tolerances = options.tolerances;
  out.steps = options.steps;
  out.budget = options.budget;
  out.cap = options.cap.value_or(0.1 * options.budget);
  out.target = options.target;
  out.rate = options.rate;
  for (const double value : out.tolerances) check("--tolerances", value);
  for (const double value : out.steps) check("--steps", value);
  check("--budget", out.budget);
  check("--cap", out.cap);
  check("--target", out.target);
  if (out.rate) check("--rate", *out.rate);
  std::sort(out.tolerances.rbegin(), out.tolerances.rend());
  std::sort(out.steps.rbegin(), out.steps.rend());
  return out;
}

/// The scene ready to run; whatever is wrong with it has been refused.
System system_of(const scene::SceneFile& file) {
  System system = scene::make_system(file);
  try {
    const Simulation simulation(system, scene::start_state(file, system), file.options);
  } catch (const InvalidInput& error) {
    throw scene::in_scene(file, error);
  }
  return system;
}

Results carry_out_with_progress(Study& study, const Plan& plan) {
  Progress progress;
  double part = 0.0;
  study.on_progress([&](double) {
    // The reference comes first, and takes as many runs as fit into its half of the budget.
    const double spent = study.spent() / plan.budget;
    progress.show("studying", std::max(part, std::min(kReferencePart, kReferencePart * 2.0 * spent)));
    return !Interrupt::requested();
  });
  return carry_out(study, plan, [&](double done) {
    part = done;
    progress.show("studying", part);
  });
}

int report(const ReportArguments& options) {
  const Interrupt interrupt;
  const scene::SceneFile file = scene::read_scene(options.scene);
  const System system = system_of(file);
  const Plan plan = plan_for(options);
  make_folder(options.out);

  Study study(file, system, plan.rate);
  try {
    const Results results = carry_out_with_progress(study, plan);
    const OrderedJson json = to_json(results, study);
    write_file_whole(options.out + "/report.svg", to_svg(results, study));
    write_file_whole(options.out + "/report.json", json.dump(2) + "\n");
    if (options.json)
      print(json);
    else
      std::cout << to_table(results, study) << options.out << '\n';
    const bool good = results.reference && results.reference->certified;
    if (!good) {
      std::cerr << "tendril: "
                << (results.reference ? "the reference is " + results.reference->statement : "no reference")
                << '\n';
    }
    return good ? kDone : kNoSuccess;
  } catch (const Study::Cancelled&) {
    std::cerr << "tendril: cancelled: nothing was written\n";
    return kNoSuccess;
  }
}

}  // namespace

Command report_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("report", "Error against run time of a scene, by method and tolerance");
  const auto options = std::make_shared<ReportArguments>();
  app->add_option("scene", options->scene, "scene file (JSON); its mesh is left out")->required();
  app->add_option("--out", options->out, "folder for report.json and report.svg; made when it is not there")
      ->required();
  app->add_option("--methods", options->methods,
                  "methods as a scene names them, by commas; default: all but the two Eulers")
      ->delimiter(',');
  app->add_option("--tolerances", options->tolerances,
                  "ladder of the methods that choose their steps, by commas")
      ->delimiter(',');
  app->add_option("--steps", options->steps,
                  "ladder of the others, by commas; default: halves of what is stable")
      ->delimiter(',');
  app->add_option("--target", options->target,
                  "position error you are after, relative to the longest curve-pair");
  app->add_option("--budget", options->budget, "CPU seconds in all");
  app->add_option("--cap", options->cap, "CPU seconds of one run; default: a tenth of the budget");
  app->add_option("--rate", options->rate,
                  "evaluations that count as a second: no clock is asked then, and the report is the same on "
                  "every machine");
  app->add_flag("--json", options->json, "print the report as JSON");
  return {app, [options] { return report(*options); }};
}

}  // namespace tendril::runner
