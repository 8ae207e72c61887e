#include "patches.h"

#include <algorithm>
#include <limits>

namespace tendril::collision {
namespace {

void take_in(Patch& patch, const Patch& other) {
  patch.first = std::min(patch.first, other.first);
  patch.last = std::max(patch.last, other.last);
  patch.low = patch.low.cwiseMin(other.low);
  patch.high = patch.high.cwiseMax(other.high);
}

/// Slabs between two neighbours in order; more than any for those of different curve-pairs.
std::uint32_t gap(const Patch& a, const Patch& b) {
  if (a.pair != b.pair) return std::numeric_limits<std::uint32_t>::max();
  return b.first > a.last ? b.first - a.last - 1 : 0;
}

void join_touching(std::vector<Patch>& patches) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < patches.size(); ++i) {
    if (gap(patches[kept], patches[i]) == 0)
      take_in(patches[kept], patches[i]);
    else
      patches[++kept] = patches[i];
  }
  patches.resize(kept + 1);
}

}  // namespace

void join_patches(std::vector<Patch>& patches, std::size_t most) {
  if (patches.empty()) return;
  std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) { return a.first < b.first; });
  join_touching(patches);
  while (patches.size() > most) {
    std::size_t best = 1;
    for (std::size_t i = 2; i < patches.size(); ++i)
      if (gap(patches[i - 1], patches[i]) < gap(patches[best - 1], patches[best])) best = i;
    if (patches[best - 1].pair != patches[best].pair) return;
    take_in(patches[best - 1], patches[best]);
    patches.erase(patches.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

AxialRange range_of(const Patch& patch) {
  AxialRange range;
  range.middle = 0.5 * patch.low + 0.5 * patch.high;
  range.radius = (patch.high - range.middle).cwiseMax(range.middle - patch.low) * (1.0 + 0x1p-50);
  range.reach = patch.low.cwiseAbs().cwiseMax(patch.high.cwiseAbs()).sum() * (1.0 + 0x1p-50);
  return range;
}

}  // namespace tendril::collision
