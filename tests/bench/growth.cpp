#include <sys/resource.h>
#include <sys/wait.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/simulation.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

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

/// Steps of one size, time and again.
class Steps {
 public:
  Steps(const Problem& problem, Method method)
      : problem_(problem), stepper_(make_stepper(method, problem.system)) {
    const bool implicit = method == Method::rodas;
    const auto work = problem.system.make_workspace();
    h_ = implicit ? 1e-3 : 0.2 / problem.system.largest_frequency(problem.start, 16, *work);
    // Alike in node-steps, so that what else the machine does disturbs all alike; many, for the first steps
    // of each find nothing in the cache.
    count_ = implicit ? std::clamp(static_cast<int>(4e4 / nodes()), 2, 100)
                      : std::clamp(static_cast<int>(2.5e6 / nodes()), 25, 25'000);
  }

  void run(int times) {
    best_ = std::min(best_, fastest(times, [&] {
                       state_ = problem_.start;
                       stepper_->restart();
                       for (int i = 0; i < count_; ++i)
                         if (!stepper_->advance(state_, h_).ok()) throw std::runtime_error("a step failed");
                     }));
  }
  /// A node and step, of the fastest run.
  double seconds() const { return best_ / (count_ * nodes()); }

 private:
  double nodes() const { return static_cast<double>(problem_.system.node_count()); }

  const Problem& problem_;
  std::unique_ptr<Stepper> stepper_;
  State state_;
  double h_ = 0.0, best_ = std::numeric_limits<double>::infinity();
  int count_ = 0;
};

/// The price of a node of a long chain in those of a short one's, run in turns: whatever else the machine
/// does meets both.
double growth_of_chain(int few, int many) {
  const Problem one = long_chain(few), other = long_chain(many);
  Steps small(one, Method::cash_karp), large(other, Method::cash_karp);
  for (int turn = 0; turn < 20; ++turn) {
    small.run(1);
    large.run(1);
  }
  return large.seconds() / small.seconds();
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
      Steps steps(problem, method);
      steps.run(method == Method::rodas ? 5 : 10);
      out.seconds = steps.seconds();
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
  if (!settings.quick) {
    const double ratio = growth_of_chain(1'000, 100'000);
    std::printf("a node of a chain of 100000 for one of 1000, in turns: %.2f (cash_karp)\n", ratio);
    out.push_back({{"shape", "chain of 100000 for 1000"}, {"method", "cash_karp"}, {"ratio", ratio}});
  }
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
