#pragma once

#include "branch_graph.h"

namespace tendril::axis {

/// A path through the tree of branches, from end to end, or from a vertex of an earlier path to an end.
struct Path {
  Line line;
  std::vector<std::uint32_t> vertices;  ///< that it goes through, in order
  std::vector<double> along;            ///< length of the line up to each of them
  std::optional<std::size_t> parent{};  ///< path on which vertices.front() lies
};

/// The longest path first, from that of its ends that is earlier among the vertices; then, path by path, the
/// longest from each branch that leaves it.
/// \param tree  without loops, connected
std::vector<Path> paths_of(const BranchGraph& tree);

/// Nodes along a path, 0 at its start and 1 at its end, with one at each of its vertices; vertices nearer
/// than half of `spacing` to one before them, or to the end, share its node.
struct Spread {
  std::vector<double> parameters;
  std::vector<std::size_t> node_of_vertex;
};

/// \param spacing  between nodes, about [length]; there are four at least
Spread spread_nodes(const Path& path, double spacing);

}  // namespace tendril::axis
