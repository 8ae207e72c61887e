#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include "bench/collision/peers.h"

namespace tendril::bench {

void fcl_meet(std::span<const test::TrianglePair> pairs, std::span<char> out) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [a, b] = pairs[i];
    out[i] = fcl::detail::Intersect<double>::intersect_Triangle(a[0], a[1], a[2], b[0], b[1], b[2]) ? 1 : 0;
  }
}

}  // namespace tendril::bench
