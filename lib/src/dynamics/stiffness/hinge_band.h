#pragma once

#include <algorithm>

#include "dynamics/rhs/workspace.h"
#include "dynamics/vector/block.h"

namespace tendril {

/// Stiffness of a rod without twist, a stretch of nodes at a time: five blocks a node j, (j, j), (j, j + 1),
/// (j + 1, j), (j, j + 2) and (j + 2, j).
struct HingeBand {
  static constexpr std::size_t kNodes = 32, kBlocks = 5;
  std::array<Block<3>, kNodes * kBlocks> block;
};

/// Second derivatives of the stretch, 1/2 k (l - L)^2 an edge, and of the hinges at free nodes, 1/4 K phi^2,
/// phi the angle between their two edges; times `scale`. Needs positions.
/// \param first, count  nodes of one rod, at most HingeBand::kNodes
void hinge_stiffness(const Model& model, const NodeRange& rod, std::size_t first, std::size_t count,
                     const Kinematics& kin, double scale, HingeBand& to);

/// Where block k of node j's five stands; `end` is the rod's.
inline BlockPlace place_in_band(std::size_t j, std::size_t end, std::size_t k) {
  const std::size_t other = j + (k + 1) / 2;
  const bool above = k % 2 == 1;
  return {above || k == 0 ? j : other, above ? other : j, other < end, false, false};
}

/// Hands the whole rod to a sink.
template <class Sink>
void visit_hinges(const Model& model, const NodeRange& rod, const Kinematics& kin, double scale, Sink& sink) {
  HingeBand band;
  const std::size_t end = rod.first + rod.count;
  for (std::size_t first = rod.first; first < end; first += HingeBand::kNodes) {
    const std::size_t count = std::min(HingeBand::kNodes, end - first);
    hinge_stiffness(model, rod, first, count, kin, scale, band);
    sink.blocks(HingeBand::kBlocks * count, band.block.data(), [&](std::size_t k) {
      return place_in_band(first + k / HingeBand::kBlocks, end, k % HingeBand::kBlocks);
    });
  }
}

}  // namespace tendril
