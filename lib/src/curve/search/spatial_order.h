#pragma once

#include <tendril/base/types.h>

#include <cstdint>
#include <vector>

namespace tendril {

/// Indices of the points in such an order that neighbours in it are mostly neighbours in space: by cell of a
/// grid over their box, the cells along Morton's curve [Morton 1966]. Finite points. O(n).
std::vector<std::uint32_t> spatial_order(Points points);

}  // namespace tendril
