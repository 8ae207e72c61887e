#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/couplings.h>

#include <limits>
#include <memory>
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

/// What a force may look at: the state of all rods on flat arrays, in the world frame.
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
  const ForceMemory* memory = nullptr;  ///< what Force::remember gave last; null before and without
};

/// Where a force adds what it does: a force per node, and a torque per node as a world vector. The torque's
/// part along the tangent drives the spin, the rest turns the tangent.
struct Loads {
  MutablePoints force;   ///< per node
  MutablePoints torque;  ///< per node

  /// Refuses the state, naming a node: a contact does where its gap is closed. The step that came here is
  /// rejected and a shorter one tried; where steps are fixed, or none is short enough, the run stops as
  /// Stop::not_evaluable.
  void refuse(std::size_t node) const {
    if (refused && *refused == kNone) *refused = node;
  }
  static constexpr std::size_t kNone =  ///< no node
      std::numeric_limits<std::size_t>::max();
  std::size_t* refused = nullptr;  ///< kNone at first; null where refusals are not asked for
};

/// An external force. Extension point: derive, say what it adds and what it couples, and hand it to the
/// system. It must be pure in the state it is shown, its memory included (an adaptive step evaluates six
/// stages and may throw them away), and safe to call from several threads.
class TENDRIL_CORE_API Force {
 public:
  virtual ~Force() = default;

  /// Adds to the loads; never overwrites.
  virtual void add(const StateView& state, const Loads& loads) const = 0;

  /// Which loads depend on which states, and their derivatives. Called once when a system is made, after
  /// check(). tendril/dynamics/check_force.h holds a force to what it says here.
  virtual Couplings couplings(std::span<const NodeRange> rods) const = 0;

  /// Called once when a system is made: throws InvalidInput when the force names a rod or node that is not
  /// there.
  virtual void check(std::span<const NodeRange>) const {}

  /// True when the force is minus the gradient of energy(); then the energy balance counts its potential
  /// instead of its work.
  virtual bool has_energy() const { return false; }
  virtual double energy(const StateView&) const { return 0.0; }  ///< at a state, in the scene's units

  /// The acceleration a, when the loads are the mass of each node times a in every state and at all times,
  /// and nothing else: such forces are summed once when a system is made, add() is not called, and their
  /// energy is -sum m a . p.
  virtual std::optional<Vec3> uniform_acceleration() const { return {}; }

  /// False when the loads are the same at all times.
  virtual bool depends_on_time() const { return true; }

  /// True when it may turn nodes about their tangents: such a scene keeps its twist state.
  virtual bool twists() const { return false; }

  /// Times where it jumps; steps end there.
  virtual std::vector<double> breaks() const { return {}; }

  /// Called at the start of a run, after each accepted step and after Simulation::change, never for a step
  /// that is rejected: what to remember from here on, which add() and energy() find as StateView::memory.
  /// A force that remembers nothing at the start is not asked again. Where the energy jumps with the memory,
  /// the jump counts as work.
  /// \param before  what it remembered so far, null at first; return it to keep it
  virtual std::shared_ptr<const ForceMemory> remember(
      const StateView&, const std::shared_ptr<const ForceMemory>& before) const {
    return before;
  }
};

}  // namespace tendril
