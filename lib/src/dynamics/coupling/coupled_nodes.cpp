#include "coupled_nodes.h"

#include <algorithm>

namespace tendril {
namespace {

/// The nodes whose positions a node's position and frame follow from, and on which its force and torque act:
/// itself and its neighbours; those of what it is attached to, too. The place and the turn of a body follow
/// from nothing else.
std::vector<std::size_t> behind(const Model& model, std::size_t node) {
  if (node >= model.nodes) return {node};
  std::vector<std::size_t> nodes;
  const auto around = [&](std::size_t i) {
    if (model.has_before(i)) nodes.push_back(model.carrier[i - 1]);
    nodes.push_back(model.carrier[i]);
    if (model.has_after(i)) nodes.push_back(model.carrier[i + 1]);
  };
  around(node);
  if (model.carrier[node] != node) around(model.carrier[node]);
  return nodes;
}

/// Calls visit(i, j), i <= j, for all pairs that are named.
template <typename Visit>
void visit_named(const Model& model, const Couplings& couplings, const Visit& visit) {
  for (const auto& [a, b] : couplings.pairs()) visit(std::min(a, b), std::max(a, b));
  if (!couplings.reach()) return;
  for (const NodeRange& rod : model.rods)
    for (std::size_t i = 0; i < rod.count; ++i)
      for (std::size_t j = i; j < rod.count && j - i <= *couplings.reach(); ++j)
        visit(rod.first + i, rod.first + j);
}

void add_coupled(const Model& model, std::size_t i, std::size_t j, bool by_frames, NodePairs& pairs) {
  if (!by_frames) {
    pairs.emplace_back(model.carrier[i], model.carrier[j]);
    return;
  }
  std::vector<std::size_t> all = behind(model, i);
  if (j != i) {
    const std::vector<std::size_t> more = behind(model, j);
    all.insert(all.end(), more.begin(), more.end());
  }
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) pairs.emplace_back(all[a], all[b]);
}

}  // namespace

NodePairs coupled_by_springs(const Model& model) {
  NodePairs pairs;
  for (const NodeRange& rod : model.rods) {
    const std::size_t reach = model.has_twist(rod.first) ? 3 : 2;
    for (std::size_t i = rod.first; i < rod.first + rod.count; ++i)
      for (std::size_t j = i + 1; j <= std::min(i + reach, rod.first + rod.count - 1); ++j)
        pairs.emplace_back(model.carrier[i], model.carrier[j]);
    const std::size_t parent = model.carrier[rod.first];
    if (parent == rod.first) continue;
    for (std::size_t j = parent - (model.has_before(parent) ? 1 : 0);
         j <= parent + (model.has_after(parent) ? 1 : 0); ++j)
      for (std::size_t i = rod.first + 1; i <= std::min(rod.first + 2, rod.first + rod.count - 1); ++i)
        pairs.emplace_back(model.carrier[j], i);
  }
  // All children of a node that turns with them.
  const auto last = [&](const Model::Hub::Child& child) {
    return child.root + std::min<std::size_t>(2, model.rods[child.rod].count - 1);
  };
  for (const Model::Hub& hub : model.hubs)
    for (const Model::Hub::Child& one : hub.children)
      for (const Model::Hub::Child& other : hub.children)
        for (std::size_t i = one.root + 1; one.root < other.root && i <= last(one); ++i)
          for (std::size_t j = other.root + 1; j <= last(other); ++j) pairs.emplace_back(i, j);
  return pairs;
}

NodePairs coupled_by_force(const Model& model, const Couplings& couplings, bool by_frames) {
  NodePairs pairs;
  visit_named(model, couplings,
              [&](std::size_t i, std::size_t j) { add_coupled(model, i, j, by_frames, pairs); });
  return pairs;
}

NodePairs coupled_by_pairs(const Model& model, const NodePairs& named, bool by_frames) {
  NodePairs pairs;
  for (const auto& [i, j] : named) add_coupled(model, i, j, by_frames, pairs);
  return pairs;
}

}  // namespace tendril
