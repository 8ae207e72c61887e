#include <tendril/dynamics/force.h>

namespace tendril {

Couplings Couplings::within(std::size_t reach) {
  Couplings all;
  all.reach_ = reach;
  return all;
}

Couplings Couplings::between(std::vector<Pair> pairs) {
  Couplings all;
  all.pairs_ = std::move(pairs);
  return all;
}

Couplings Couplings::among(const std::vector<std::size_t>& nodes) {
  Couplings all;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a; b < nodes.size(); ++b) all.pairs_.emplace_back(nodes[a], nodes[b]);
  return all;
}

Couplings Force::couplings_with_bodies(std::span<const NodeRange> rods, std::size_t) const {
  return couplings(rods);
}

Couplings Couplings::with(Derivatives derivatives) && {
  derivatives_ = std::move(derivatives);
  return std::move(*this);
}

Couplings Couplings::at_states(Local local) && {
  local_ = std::move(local);
  return std::move(*this);
}

}  // namespace tendril
