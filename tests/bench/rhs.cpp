#include "bench/clock.h"
#include "bench/limits.h"
#include "bench/sections.h"

namespace tendril::bench {
namespace {

double derivative_ns(const Problem& problem, bool quick) {
  const auto work = problem.system.make_workspace();
  const Eigen::VectorXd& y = problem.start.y;
  Eigen::VectorXd dy = y;
  const double seconds = fastest_of_many(quick ? 3 : 7, 0.05, [&] {
    if (!problem.system.derivative(problem.start, 0.0, y, dy, *work).ok())
      throw std::runtime_error("the bench's own scene could not be evaluated");
  });
  return 1e9 * seconds / static_cast<double>(problem.system.node_count());
}

struct Line {
  int rods, nodes;
  double target;  ///< [ns a node]; 0 for none
};

}  // namespace

OrderedJson right_hand_side(const Settings& settings) {
  heading("Right-hand side",
          "System::derivative, ns a node; chain: the plainest mass-spring loop here; bytes: a node's "
          "96 bytes moved; targets 15, and 6 batched, for the full model");
  Table table({"model", "rods x nodes", "ns/node", "target", "chain", "x chain", "bytes"});
  OrderedJson out = OrderedJson::array();
  for (const bool full : {false, true}) {
    for (const Line& line : {Line{1, 32, 0}, {1, 128, 0}, {1, 1024, 15}, {1, 100'000, 0}, {256, 32, 6}}) {
      const Problem problem = stirred_rods(line.rods, line.nodes, full);
      const auto nodes = static_cast<std::size_t>(line.rods) * static_cast<std::size_t>(line.nodes);
      const double ns = derivative_ns(problem, settings.quick);
      const double chain = plain_chain_ns(nodes), bytes = bytes_ns(nodes);
      const bool aimed = full && line.target > 0;
      table.row({problem.name, std::to_string(line.rods) + " x " + std::to_string(line.nodes),
                 text("%.1f", ns), aimed ? text("%.0f", line.target) : "", text("%.1f", chain),
                 text("%.1f", ns / chain), text("%.1f", bytes)});
      out.push_back({{"model", problem.name},
                     {"rods", line.rods},
                     {"nodes", line.nodes},
                     {"ns_per_node", ns},
                     {"target_ns", aimed ? OrderedJson(line.target) : OrderedJson()},
                     {"plain_chain_ns", chain},
                     {"bytes_ns", bytes}});
    }
  }
  table.print();
  return out;
}

/// With and without wind: what the wind takes is the difference.
OrderedJson trees_in_wind(const Settings& settings) {
  heading(
      "Trees in wind",
      "System::derivative of viscous trees that are bent, ns a node; target 40, and the wind at most what is "
      "left without it");
  Table table({"tree", "ns/node", "target", "without wind", "the wind"});
  OrderedJson out = OrderedJson::array();
  for (const Plant& what : {Plant{10, 41, 1e6}, {100, 101, 1e6}, {200, 41, 1e8}}) {
    const Problem problem = swaying(what, true);
    const double with = derivative_ns(problem, settings.quick);
    const double without = derivative_ns(swaying(what, false), settings.quick);
    table.row({problem.name, text("%.1f", with), "40", text("%.1f", without), text("%.1f", with - without)});
    out.push_back({{"tree", problem.name}, {"ns_per_node", with}, {"without_wind", without}});
  }
  table.print();
  return out;
}

}  // namespace tendril::bench
