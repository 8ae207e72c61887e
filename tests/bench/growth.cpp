#include <sys/resource.h>
#include <sys/wait.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/simulation.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "bench/clock.h"
#include "bench/sections.h"

namespace tendril::bench {
namespace {

/// What a child process reports of one case.
struct Growth {
  bool available = false;
  double seconds = 0.0;   ///< a node and step
  double bytes = 0.0;     ///< a node, at the peak
  char reason[128] = "";  ///< why it is not available
};

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  in >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double seconds_per_node_step(const Problem& problem, Method method) {
  const auto work = problem.system.make_workspace();
  const double nodes = static_cast<double>(problem.system.node_count());
  const double h =
      method == Method::rodas ? 1e-3 : 0.2 / problem.system.largest_frequency(problem.start, 16, *work);
  // Alike in node-steps, so that what else the machine does disturbs all alike; many, for the first steps of
  // each find nothing in the cache.
  const int steps = method == Method::rodas ? std::clamp(static_cast<int>(4e4 / nodes), 2, 100)
                                            : std::clamp(static_cast<int>(2.5e6 / nodes), 25, 25'000);
  const std::unique_ptr<Stepper> stepper = make_stepper(method, problem.system);
  State state = problem.start;
  const double seconds = fastest(method == Method::rodas ? 5 : 10, [&] {
    state = problem.start;
    stepper->restart();
    for (int i = 0; i < steps; ++i)
      if (!stepper->advance(state, h).ok()) throw std::runtime_error("a step failed");
  });
  return seconds / (steps * nodes);
}

/// In a process of its own, so that its peak memory is its own.
template <class Make>
Growth measure(const Make& make, Method method) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    Growth out;
    try {
      const double before = resident_bytes();
      const Problem problem = make();
      out.seconds = seconds_per_node_step(problem, method);
      rusage usage{};
      getrusage(RUSAGE_SELF, &usage);
      out.bytes = (1024.0 * static_cast<double>(usage.ru_maxrss) - before) /
                  static_cast<double>(problem.system.node_count());
      out.available = true;
    } catch (const std::exception& error) {
      std::snprintf(out.reason, sizeof out.reason, "%s", error.what());
    }
    const bool told = write(ends[1], &out, sizeof out) == sizeof out;
    _exit(told ? 0 : 1);
  }
  Growth out;
  close(ends[1]);
  if (read(ends[0], &out, sizeof out) != sizeof out) out = {};
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return out;
}

void add(Table& table, OrderedJson& out, const std::string& shape, Method method, const Growth& growth) {
  const char* name = tendril::to_string(method);
  if (!growth.available) {
    table.row({shape, name, "not available", growth.reason});
    out.push_back({{"shape", shape}, {"method", name}, {"available", false}, {"reason", growth.reason}});
    return;
  }
  table.row({shape, name, text("%.0f", 1e9 * growth.seconds), text("%.0f", growth.bytes)});
  out.push_back({{"shape", shape},
                 {"method", name},
                 {"available", true},
                 {"ns_per_node_step", 1e9 * growth.seconds},
                 {"bytes_per_node", growth.bytes}});
}

}  // namespace

OrderedJson growth(const Settings& settings) {
  heading("Growth", "linear when a row repeats: ns a node and step, peak bytes a node (scene and stepper)");
  Table table({"shape", "method", "ns/(node step)", "bytes/node"});
  OrderedJson out = OrderedJson::array();
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    for (const int nodes : {1'000, 10'000, 100'000})
      if (!settings.quick || nodes <= 10'000)
        add(table, out, "chain of " + std::to_string(nodes), method,
            measure([&] { return long_chain(nodes); }, method));
    for (const int rods : {1, 256})
      add(table, out, std::to_string(rods) + (rods == 1 ? " rod of 32" : " rods of 32"), method,
          measure([&] { return stirred_rods(rods, 32, false); }, method));
    for (const int leaves : {10, 100, 1000})
      if (!settings.quick || leaves <= 100)
        add(table, out, "tree of " + std::to_string(leaves) + " leaves", method,
            measure(
                [&] {
                  return plant({leaves, leaves + 1, 1e6});
                },
                method));
  }
  table.print();
  return out;
}

OrderedJson plant_in_real_time(Settings& settings) {
  const Plant what;
  const Problem problem = plant(what);
  heading("A plant", "stem and " + std::to_string(what.leaves) + " leaves, " +
                         std::to_string(problem.system.node_count()) + " masses, E " +
                         text("%.0e", what.young) + ", one second; target below one second");
  Table table({"method", "tolerance", "CPU", "steps", "evaluations", "outcome"});
  OrderedJson out = OrderedJson::array();
  for (const Solver& solver : own_solvers()) {
    for (const double tolerance : {1e-2, 1e-3}) {
      Trial trial;
      try {
        trial = solver.run(problem, tolerance, settings.quick ? 1.0 : 10.0);
      } catch (const InvalidInput& error) {
        trial.failure = std::string("not available: ") + error.what();
      }
      const double whole = trial.seconds * problem.duration / std::max(trial.reached, 1e-12);
      const std::string outcome = trial.capped ? "extrapolated" : trial.done() ? "finished" : trial.failure;
      table.row({solver.name, text("%.0e", tolerance),
                 trial.failure.empty() ? (trial.capped ? "~" : "") + duration(whole) : "-",
                 std::to_string(trial.steps), std::to_string(trial.evaluations), outcome});
      out.push_back({{"method", solver.name}, {"tolerance", tolerance}, {"outcome", outcome}});
      if (trial.failure.empty()) out.back()["seconds"] = whole;
    }
  }
  table.print();
  return out;
}

}  // namespace tendril::bench
