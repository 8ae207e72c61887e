#pragma once

#include <tendril/dynamics/force.h>

namespace tendril::contact {

/// Adds all pairs of some nodes, flat indices.
inline void couple(const std::vector<std::size_t>& nodes, LocalCouplings& to) {
  const Couplings all = Couplings::among(nodes);
  to.pairs.insert(to.pairs.end(), all.pairs().begin(), all.pairs().end());
}

}  // namespace tendril::contact
