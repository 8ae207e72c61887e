#pragma once

#include "branch_graph.h"

namespace tendril::axis {

/// A way through the tree of branches, from end to end, or from a place of an earlier path to an end.
struct Path {
  Line line;
  std::vector<std::uint32_t> places;    ///< that it goes through, in order
  std::vector<double> along;            ///< length of the line up to each of them
  std::optional<std::size_t> parent{};  ///< path on which places.front() lies
};

/// The longest path first, from that of its ends that is earlier among the places; then, path by path, the
/// longest from each branch that leaves it. \param tree  without loops, connected
std::vector<Path> paths_of(const BranchGraph& tree);

}  // namespace tendril::axis
