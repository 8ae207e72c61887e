#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/couplings.h>
#include <tendril/dynamics/loads.h>

#include <memory>

namespace tendril {

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
  ///
  /// Flat indices count the n nodes, then two for every body: n + 2b stands for the place of body b and the
  /// force on it, n + 2b + 1 for its turn and the torque on it about its centre of mass.
  virtual Couplings couplings(std::span<const NodeRange> rods) const = 0;

  /// The same, for a force that has to know how many bodies there are; this one is called, and by default
  /// calls couplings().
  virtual Couplings couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const;

  /// Called once when a system is made: throws InvalidInput when the force names a rod or node that is not
  /// there.
  virtual void check(std::span<const NodeRange>) const {}

  /// True when the force is minus the gradient of energy(); then the energy balance counts its potential
  /// instead of its work.
  virtual bool has_energy() const { return false; }
  virtual double energy(const StateView&) const { return 0.0; }  ///< at a state, in the scene's units

  /// The acceleration a, when the loads are the mass of each node and body times a in every state and at all
  /// times, and nothing else: such forces are summed once when a system is made, add() is not called, and
  /// their energy is -sum m a . p.
  virtual std::optional<Vec3> uniform_acceleration() const { return {}; }

  /// True when add() may refuse a state. The state at which a step ends is then asked before it is accepted,
  /// for an evaluation of those forces: explicit steps look at it only when they set out from it.
  virtual bool refuses() const { return false; }

  /// False when the loads are the same at all times.
  virtual bool depends_on_time() const { return true; }

  /// False when it neither looks at frames (t, m, spin and turn of a state) nor adds torques on nodes. Where
  /// no force of a scene does, all of these may be empty in what it is shown.
  virtual bool acts_on_frames() const { return true; }

  /// True when it may turn nodes about their tangents: such a scene keeps its twist state.
  virtual bool twists() const { return false; }

  /// Times where it jumps; steps end there.
  virtual std::vector<double> breaks() const { return {}; }
  /// The shortest period with which it comes and goes at a place of itself [time]. Steps that are chosen stay
  /// below half of it: the stages of a longer one may meet the same phase every time.
  virtual double period() const { return std::numeric_limits<double>::infinity(); }

  /// Called at the start of a run, after each accepted step and after Simulation::change, never for a step
  /// that is rejected: what to remember from here on, which add() and energy() find as StateView::memory.
  /// A force that remembers nothing at the start is not asked again. Where the energy jumps with the memory,
  /// the jump counts as work.
  /// May throw InvalidInput, saying why, for the state of a start that add() refuses.
  /// \param before  what it remembered so far, null at first; return it to keep it
  virtual std::shared_ptr<const ForceMemory> remember(
      const StateView&, const std::shared_ptr<const ForceMemory>& before) const {
    return before;
  }
};

}  // namespace tendril
