#pragma once

#include "dynamics/rhs/workspace.h"
#include "dynamics/vector/block.h"

namespace tendril {

/// Stiffness (edge_stiffness.h) of four neighbouring edges at once, none of which begins a rod that is
/// attached to another: 16 blocks an edge, rows by columns, by the nodes i - 1 .. i + 2 and the angles of i
/// and i + 1.
struct EdgePack {
  static constexpr std::size_t kEdges = 4, kSlots = 4, kBlocks = kSlots * kSlots;
  std::array<Block<4>, kEdges * kBlocks> block;
};

/// That of edges i .. i + 3 of one rod, times `scale`.
void edge_stiffness(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                    bool viscous, double scale, EdgePack& to);

/// Likewise edge_resistance, times `scale`.
void edge_resistance(const Model& model, std::size_t i, const Kinematics& kin, double scale, EdgePack& to);

/// Where block k of edge i's 16 stands.
BlockPlace place_in_pack(const Model& model, std::size_t i, std::size_t k);

}  // namespace tendril
