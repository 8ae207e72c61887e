#pragma once

#include "edge_pack.h"

namespace tendril {

/// EdgeSlopes (edge_stiffness.h) of four neighbouring edges at once: the gradients of both deviations at
/// either end and of the twist, by the vectors along the edges before, at and after (those that a spring
/// sees), and by the angle of its node; that of the twist by both angles is -1 and 1.
struct SlopePack {
  static constexpr std::size_t kVectors = 11, kAngles = 4;
  double along[kVectors][3][EdgePack::kEdges];
  double angle[kAngles][EdgePack::kEdges];
};

/// Of edges i .. i + 3 of one rod, at any state near the reference.
void edge_slopes(std::size_t i, const State& reference, const Kinematics& kin, SlopePack& to);

/// TurnedResistance and turned_pull of the same edges, times minus their viscosity.
/// \param at             slopes at the state, of which kin holds the velocities too
/// \param before, later  likewise at states `apart` apart in time
void turned_resistance(const Model& model, std::size_t i, const Kinematics& kin, const SlopePack& at,
                       const SlopePack& before, const SlopePack& later, double apart, EdgePack& to);

}  // namespace tendril
