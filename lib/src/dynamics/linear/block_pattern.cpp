#include "block_pattern.h"

#include <algorithm>

namespace tendril {

BlockPattern::BlockPattern(std::vector<std::size_t> order,
                           const std::vector<std::pair<std::size_t, std::size_t>>& couplings,
                           std::size_t most)
    : order_(std::move(order)), pivot_(order_.size()) {
  for (std::size_t k = 0; k < size(); ++k) pivot_[order_[k]] = k;
  std::vector<std::vector<std::size_t>> neighbours(size());
  for (const auto& [a, b] : couplings) {
    const auto [low, high] = std::minmax(pivot_[a], pivot_[b]);
    if (low != high) neighbours[low].push_back(high);
  }
  complete_ = eliminate(neighbours, most);
  if (complete_) index();
}

// Eliminating pivot k couples all its later neighbours with each other. It is enough to hand the list over to
// the first of them, f: the pairs with f are those of f's list from now on, and the others (a, b) arise again
// when f, which couples with both, is eliminated, since f < a, b. So each list is the pattern of a column of
// L, which lies but for its first entry in that of its parent in the elimination tree, and no pair is listed
// that elimination does not fill.
bool BlockPattern::eliminate(std::vector<std::vector<std::size_t>>& neighbours, std::size_t most) {
  std::size_t products = 0;
  for (std::size_t k = 0; k < size(); ++k) {
    auto& list = neighbours[k];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    products += list.size() * (list.size() + 1) / 2;
    if (products > most) return false;
    // What a pivot leaves behind among its later neighbours is taken over by the first of them.
    if (list.size() > 1) neighbours[list[0]].insert(neighbours[list[0]].end(), list.begin() + 1, list.end());
    begin_.push_back(later_.size());
    later_.insert(later_.end(), list.begin(), list.end());
    low_.resize(later_.size(), k);
  }
  begin_.push_back(later_.size());
  return true;
}

void BlockPattern::index() {
  earlier_.resize(size());
  for (std::size_t e = 0; e < later_.size(); ++e) earlier_[later_[e]].push_back(e);
  for (std::size_t k = 0; k < size(); ++k) {
    first_pair_.push_back(pairs_.size());
    for (std::size_t a = begin_[k]; a < begin_[k + 1]; ++a)
      for (std::size_t b = a + 1; b < begin_[k + 1]; ++b) pairs_.push_back(entry(later_[a], later_[b]));
  }
}

}  // namespace tendril
