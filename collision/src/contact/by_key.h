#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tendril::contact {

/// The entry with a key, of those by ascending key; null where there is none. O(log n).
template <class Entry>
const Entry* find_key(const std::vector<Entry>& entries, std::uint64_t key) {
  const auto at = std::lower_bound(entries.begin(), entries.end(), key,
                                   [](const Entry& entry, std::uint64_t k) { return entry.key < k; });
  return at != entries.end() && at->key == key ? &*at : nullptr;
}

/// Brings entries into that order.
template <class Entry>
void sort_by_key(std::vector<Entry>& entries) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
}

}  // namespace tendril::contact
