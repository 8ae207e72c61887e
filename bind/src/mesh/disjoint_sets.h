#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tendril::bind {

/// Disjoint sets of the numbers below `count`, each number alone at first, with path halving. The smallest
/// number of a set is its root, so the result does not depend on the order of joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  bool is_root(std::uint32_t i) const { return parent_[i] == i; }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace tendril::bind
