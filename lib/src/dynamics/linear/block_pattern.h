#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tendril {

/// Which nodes' blocks of a matrix couple, and what elimination in a given order fills in. Pivots are counted
/// in that order; a pivot's later neighbours are those that it still couples with when it is eliminated.
///
/// A rod eliminated from its tip to its root, children before their parents, fills in next to nothing: O(n)
/// entries.
class BlockPattern {
 public:
  /// \param order      the nodes, each once, in the order of elimination
  /// \param couplings  pairs of nodes; doubles and pairs of a node with itself are allowed
  /// \param most       products of blocks that elimination may take (of l later neighbours l (l + 1) / 2);
  ///                   what needs more is not complete, and has no entries
  BlockPattern(std::vector<std::size_t> order,
               const std::vector<std::pair<std::size_t, std::size_t>>& couplings,
               std::size_t most = std::numeric_limits<std::size_t>::max());
  bool complete() const { return complete_; }

  std::size_t size() const { return order_.size(); }
  std::size_t entries() const { return later_.size(); }
  std::size_t node(std::size_t pivot) const { return order_[pivot]; }
  const std::vector<std::size_t>& nodes() const { return order_; }
  std::size_t pivot(std::size_t node) const { return pivot_[node]; }

  /// Later neighbours of a pivot, ascending: those from begin(pivot) to begin(pivot + 1).
  std::size_t begin(std::size_t pivot) const { return begin_[pivot]; }
  std::size_t later(std::size_t entry) const { return later_[entry]; }
  const std::size_t* begin() const { return begin_.data(); }
  const std::size_t* later() const { return later_.data(); }
  std::size_t low(std::size_t entry) const { return low_[entry]; }  ///< the pivot whose entry it is

  /// Entry of the pair of pivots (low, high), low < high; size of entries() where they do not couple.
  std::size_t entry(std::size_t low, std::size_t high) const {
    const auto end = later_.begin() + static_cast<std::ptrdiff_t>(begin_[low + 1]);
    const auto at = std::lower_bound(later_.begin() + static_cast<std::ptrdiff_t>(begin_[low]), end, high);
    return at != end && *at == high ? static_cast<std::size_t>(at - later_.begin()) : later_.size();
  }

  /// Entries in which a pivot is the later one.
  const std::vector<std::size_t>& earlier(std::size_t pivot) const { return earlier_[pivot]; }

  /// Entries of the pairs (a, b), a < b, of the later neighbours of a pivot, b running fastest.
  const std::size_t* pairs(std::size_t pivot) const { return pairs_.data() + first_pair_[pivot]; }

 private:
  bool eliminate(std::vector<std::vector<std::size_t>>& neighbours, std::size_t most);
  void index();

  std::vector<std::size_t> order_, pivot_;
  std::vector<std::size_t> begin_, later_, low_;
  std::vector<std::vector<std::size_t>> earlier_;
  std::vector<std::size_t> first_pair_, pairs_;
  bool complete_ = false;
};

}  // namespace tendril
