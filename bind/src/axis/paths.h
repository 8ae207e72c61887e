#pragma once

#include "branch_graph.h"

namespace tendril::axis {

/// Ends of a line that are another's too.
struct Stays {
  bool first = false, last = false;
};

/// A path through the tree of branches, from end to end, or from a vertex of an earlier path to an end.
struct Path {
  Line line;
  std::vector<std::uint32_t> vertices;  ///< that it goes through, in order
  std::vector<double> along;            ///< length of the line up to each of them
  std::optional<std::size_t> parent{};  ///< path on which vertices.front() lies
  Stays stays{};                        ///< the first at a parent; either at a cut
};

/// The longest path first, from that of its ends that is earlier among the vertices; then, path by path, the
/// longest from each branch that leaves it.
/// \param tree       without loops, connected
/// \param first_cut  vertices from there on are ends of loops that were cut
std::vector<Path> paths_of(const BranchGraph& tree, std::size_t first_cut);

/// Nodes along a path, 0 at its start and 1 at its end, with one at each of its vertices; vertices nearer
/// than half of `spacing` to one before them, or to the end, share its node.
struct Spread {
  std::vector<double> parameters;
  std::vector<std::size_t> node_of_vertex;
};

/// \param spacing  between nodes, about [length]; there are four at least
Spread spread_nodes(const Path& path, double spacing);

}  // namespace tendril::axis
