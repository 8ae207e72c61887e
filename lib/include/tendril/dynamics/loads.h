#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/body.h>

#include <cstddef>
#include <limits>
#include <span>

namespace tendril {

/// Nodes [first, first + count) of the flat arrays belong to one rod; edge i joins the nodes i and i + 1.
struct NodeRange {
  std::size_t first;  ///< flat index
  std::size_t count;  ///< of nodes
};

/// What a force remembers from one accepted step to the next: the outcome of a broad phase, friction anchors.
/// Derive. Never changed once made, and kept in the State: runs of one system side by side share none, and a
/// copy of a state goes on as the state does.
struct TENDRIL_CORE_API ForceMemory {
  virtual ~ForceMemory() = default;
};

/// What a force may look at: the state of all rods and bodies on flat arrays, in the world frame.
struct StateView {
  double time;                    ///< [time]
  Points p;                       ///< positions of the masses
  Points v;                       ///< their velocities
  Points t;                       ///< unit tangents
  std::span<const double> spin;   ///< angular velocity about the tangent; 0 where the twist state is left out
  std::span<const double> mass;   ///< per node
  std::span<const double> width;  ///< per edge (index of its first node)
  std::span<const NodeRange> rods;  ///< where the rods stand in the arrays
  Points m = {};  ///< unit directors, across the tangents; zero vectors where the twist state is left out
  const ForceMemory* memory = nullptr;    ///< what Force::remember gave last; null before and without
  std::span<const BodyView> bodies = {};  ///< one each, in the scene's order
  Points turn = {};                       ///< angular velocities of the node frames, spin included
};

/// Where a force adds what it does: a force per node, and a torque per node as a world vector. The torque's
/// part along the tangent drives the spin, the rest turns the tangent. And a force and a torque per body.
struct Loads {
  MutablePoints force;   ///< per node
  MutablePoints torque;  ///< per node

  /// Refuses the state, naming a node or a body (flat index, see Force::couplings): a contact does where its
  /// gap is closed. The step that came here is rejected and a shorter one tried; where steps are fixed, or
  /// none is short enough, the run stops as Stop::not_evaluable. See Force::refuses.
  void refuse(std::size_t node) const {
    if (refused && *refused == kNone) *refused = node;
  }
  static constexpr std::size_t kNone =  ///< no node
      std::numeric_limits<std::size_t>::max();
  std::size_t* refused = nullptr;  ///< kNone at first; null where refusals are not asked for
  std::span<Wrench> bodies = {};   ///< one each, in the scene's order
};

}  // namespace tendril
