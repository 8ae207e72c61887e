#include "paths.h"

#include <algorithm>
#include <cmath>

namespace tendril::axis {
namespace {

/// The longest chains of branches into the tree from a vertex, by branches not yet taken.
class LongestChains {
 public:
  explicit LongestChains(const BranchGraph& tree)
      : tree_(tree), at_(tree.vertices.size()), taken_(tree.branches.size(), false) {
    for (std::size_t b = 0; b < tree.branches.size(); ++b) {
      at_[tree.branches[b].from].push_back(b);
      at_[tree.branches[b].to].push_back(b);
      length_.push_back(length_of(tree.branches[b].line));
    }
  }

  std::vector<std::size_t> open(std::uint32_t vertex) const {
    std::vector<std::size_t> out;
    for (const std::size_t b : at_[vertex])
      if (!taken_[b]) out.push_back(b);
    return out;
  }

  std::uint32_t other(std::size_t branch, std::uint32_t vertex) const {
    const Branch& b = tree_.branches[branch];
    return b.from == vertex ? b.to : b.from;
  }

  /// The longest chain from there, last branch first, that does not go back by `from`.
  struct Chain {
    double length = 0.0;
    std::vector<std::size_t> branches{};
  };
  Chain longest(std::uint32_t vertex, std::size_t from) const {
    Chain best;
    for (const std::size_t b : open(vertex)) {
      if (b == from) continue;
      Chain chain = along(vertex, b);
      if (chain.length > best.length) best = std::move(chain);
    }
    return best;
  }
  Chain along(std::uint32_t vertex, std::size_t branch) const {
    Chain chain = longest(other(branch, vertex), branch);
    chain.length += length_[branch];
    chain.branches.push_back(branch);
    return chain;
  }

  Path take(std::uint32_t vertex, const Chain& chain, std::optional<std::size_t> parent) {
    Path path{{tree_.vertices[vertex]}, {vertex}, {0.0}, parent};
    for (auto b = chain.branches.rbegin(); b != chain.branches.rend(); ++b) {
      taken_[*b] = true;
      Line line = tree_.branches[*b].line;
      if (tree_.branches[*b].from != vertex) std::reverse(line.begin(), line.end());
      path.line.insert(path.line.end(), line.begin() + 1, line.end());
      vertex = other(*b, vertex);
      path.vertices.push_back(vertex);
      path.along.push_back(path.along.back() + length_[*b]);
    }
    return path;
  }

  std::uint32_t end_of(std::uint32_t vertex, const Chain& chain) const {
    for (auto b = chain.branches.rbegin(); b != chain.branches.rend(); ++b) vertex = other(*b, vertex);
    return vertex;
  }

 private:
  const BranchGraph& tree_;
  std::vector<std::vector<std::size_t>> at_;
  std::vector<bool> taken_;
  std::vector<double> length_;
};

}  // namespace

// The longest path of a tree has an end that is farthest from whatever vertex one starts at: were the
// farthest vertex x from v none, replacing the far half of the longest path, where the way from v meets it,
// by the way to x would make a longer one. So two searches find it. What is left hangs on it, and is taken
// apart by the same rule, a chain as long as can be from each vertex that a path runs through.
std::vector<Path> paths_of(const BranchGraph& tree, std::size_t first_cut) {
  std::vector<Path> out;
  if (tree.branches.empty()) return out;
  constexpr std::size_t none = ~std::size_t{0};
  LongestChains chains(tree);
  const std::uint32_t any = tree.branches.front().from;
  const std::uint32_t one = chains.end_of(any, chains.longest(any, none));
  const std::uint32_t two = chains.end_of(one, chains.longest(one, none));
  const std::uint32_t start = std::min(one, two);
  out.push_back(chains.take(start, chains.longest(start, none), std::nullopt));
  for (std::size_t p = 0; p < out.size(); ++p) {
    const std::vector<std::uint32_t> vertices = out[p].vertices;
    for (const std::uint32_t vertex : vertices)
      for (const std::size_t b : chains.open(vertex))
        out.push_back(chains.take(vertex, chains.along(vertex, b), p));
  }
  for (Path& path : out)
    path.stays = {path.parent || path.vertices.front() >= first_cut, path.vertices.back() >= first_cut};
  return out;
}

Spread spread_nodes(const Path& path, double spacing) {
  const double length = path.along.back();
  std::vector<double> stops{0.0};
  std::vector<std::size_t> stop_of_vertex;
  for (const double along : path.along) {
    const bool apart = along - stops.back() >= 0.5 * spacing && length - along >= 0.5 * spacing;
    if (apart) stops.push_back(along);
    stop_of_vertex.push_back(stops.size() - (along == length || length - along < 0.5 * spacing ? 0 : 1));
  }
  stops.push_back(length);
  stop_of_vertex.front() = 0;
  const std::size_t pieces = stops.size() - 1;
  const double least = std::ceil(3.0 / static_cast<double>(pieces));
  Spread out{{0.0}, {}};
  std::vector<std::size_t> node_of_stop{0};
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const double step = stops[k] - stops[k - 1];
    const double edges = std::clamp(std::round(step / spacing), least, 10000.0);
    for (double e = 1.0; e <= edges; ++e)
      out.parameters.push_back((stops[k - 1] + step * e / edges) / length);
    node_of_stop.push_back(out.parameters.size() - 1);
  }
  for (const std::size_t stop : stop_of_vertex) out.node_of_vertex.push_back(node_of_stop[stop]);
  return out;
}

}  // namespace tendril::axis
