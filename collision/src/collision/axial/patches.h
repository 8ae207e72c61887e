#pragma once

#include <cstdint>
#include <vector>

#include "slab.h"

namespace tendril::collision {

/// A box in the axial space of one curve-pair: neighbouring slabs [first, last], and ranges of u, v and w.
struct Patch {
  std::uint32_t pair, first, last;
  Vec3 low, high;  ///< of (u, v, w), each with 0 for w
};

/// Joins patches until those of a curve-pair lie slabs apart, and there are at most `most` of them or one a
/// curve-pair: the nearest first. What the result covers only grows.
void join_patches(std::vector<Patch>& patches, std::size_t most);

/// (u, v, w) of a patch as bound() takes it, rounded outward.
AxialRange range_of(const Patch& patch);

}  // namespace tendril::collision
