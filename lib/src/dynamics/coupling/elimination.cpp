#include "elimination.h"

#include <tendril/base/error.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "coupled_nodes.h"

namespace tendril {
namespace {

/// The nodes of a rod: from its tip to its root where it has a parent, else from both ends to the middle.
std::vector<std::size_t> inwards(const Model& model, std::size_t rod) {
  const NodeRange& nodes = model.rods[rod];
  std::vector<std::size_t> order;
  for (std::size_t low = nodes.first, high = nodes.first + nodes.count; low < high;) {
    order.push_back(--high);
    if (low < high && !model.attachment_of(rod)) order.push_back(low++);
  }
  return order;
}

bool rides_on(const Model& model, std::size_t child, std::size_t parent) {
  const Model::Attachment* attached = model.attachment_of(child);
  return attached && attached->parent - model.rods[parent].first < model.rods[parent].count;
}

/// Bodies in an order that fills in little where each meets its neighbours alone, as in a heap [Amestoy,
/// Davis, Duff 1996].
std::vector<std::size_t> bodies_in_order(const Model& model, const NodePairs& coupled) {
  const auto count = static_cast<Eigen::Index>(model.bodies.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b] : coupled)
    if (std::min(a, b) >= model.nodes) {
      const auto row = static_cast<Eigen::Index>((a - model.nodes) / 2);
      const auto column = static_cast<Eigen::Index>((b - model.nodes) / 2);
      if (row != column) entries.emplace_back(row, column, 1.0), entries.emplace_back(column, row, 1.0);
    }
  std::vector<std::size_t> order(model.bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (entries.empty()) return order;
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> found;
  Eigen::AMDOrdering<int>()(graph, found);
  for (Eigen::Index k = 0; k < count; ++k)
    order[static_cast<std::size_t>(k)] = static_cast<std::size_t>(found.indices()[k]);
  return order;
}

/// Children before their parents, each from its tips; bodies last. Elimination is a chain of steps that each
/// wait for the one before; two chains that do not touch, the halves of a rod or two rods side by side, run
/// at once in one core.
std::vector<std::size_t> elimination_order(const Model& model, const NodePairs& coupled) {
  std::vector<std::size_t> order;
  for (auto r = model.order.rbegin(); r != model.order.rend(); ++r) {
    const std::vector<std::size_t> one = inwards(model, *r);
    std::vector<std::size_t> two;
    const bool paired = r + 1 != model.order.rend() && !rides_on(model, *r, *(r + 1));
    if (paired) two = inwards(model, *++r);
    for (std::size_t k = 0; k < std::max(one.size(), two.size()); ++k) {
      if (k < one.size()) order.push_back(one[k]);
      if (k < two.size()) order.push_back(two[k]);
    }
  }
  // A body may couple with many nodes, and one after the other they widen no others' rows but its own.
  for (const std::size_t body : bodies_in_order(model, coupled))
    for (const std::size_t turn : {0, 1}) order.push_back(model.nodes + 2 * body + turn);
  return order;
}

[[noreturn]] void refuse(const Model::Acting& acting, const NodePairs& pairs, std::size_t most) {
  const auto [a, b] = *std::max_element(pairs.begin(), pairs.end(), [](const auto& one, const auto& two) {
    const auto far = [](const auto& pair) {
      return std::max(pair.first, pair.second) - std::min(pair.first, pair.second);
    };
    return far(one) < far(two);
  });
  throw InvalidInput(name_of_force(acting.index),
                     "couples " + std::to_string(pairs.size()) + " pairs of nodes, " + std::to_string(a) +
                         " and " + std::to_string(b) + " among them",
                     "couplings whose elimination takes at most " + std::to_string(most) +
                         " products of blocks, or a method without linear equations");
}

}  // namespace

BlockPattern pattern_of_equations(const Model& model, const NodePairs& now) {
  const std::size_t most = std::max<std::size_t>(std::size_t{1} << 24, 64 * model.nodes);
  NodePairs pairs = coupled_by_springs(model);
  for (const Model::Acting& acting : model.acting) {
    if (acting.varies()) continue;
    const NodePairs more = coupled_by_force(model, acting.couplings, acting.by_differences());
    pairs.insert(pairs.end(), more.begin(), more.end());
  }
  pairs.insert(pairs.end(), now.begin(), now.end());
  const std::vector<std::size_t> order = elimination_order(model, pairs);
  BlockPattern all(order, pairs, most);
  if (all.complete() || !now.empty()) return all;
  pairs = coupled_by_springs(model);
  for (const Model::Acting& acting : model.acting) {
    if (acting.varies()) continue;
    const NodePairs more = coupled_by_force(model, acting.couplings, acting.by_differences());
    pairs.insert(pairs.end(), more.begin(), more.end());
    if (!BlockPattern(order, pairs, most).complete()) refuse(acting, more, most);
  }
  return all;
}

}  // namespace tendril
