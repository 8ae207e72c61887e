#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <optional>
#include <span>
#include <vector>

namespace tendril {

/// Nodes [first, first + count) of the flat arrays belong to one rod; edge i joins the nodes i and i + 1.
struct NodeRange {
  std::size_t first, count;
};

/// What a force may look at: the state of all rods on flat arrays, in the world frame.
struct StateView {
  double time;
  Points p, v;                    ///< positions and velocities of the masses
  Points t;                       ///< unit tangents
  std::span<const double> spin;   ///< angular velocity about the tangent; 0 where the twist state is left out
  std::span<const double> mass;   ///< per node
  std::span<const double> width;  ///< per edge (index of its first node)
  std::span<const NodeRange> rods;
  Points m = {};  ///< unit directors, across the tangents; zero vectors where the twist state is left out
};

/// Where a force adds what it does: a force per node, and a torque per node as a world vector. The torque's
/// part along the tangent drives the spin, the rest turns the tangent.
struct Loads {
  MutablePoints force;
  MutablePoints torque;
};

/// Where a force adds its derivatives: of the force on node i by the position and the velocity of node j of
/// the same rod, at most two nodes away.
class TENDRIL_CORE_API LoadDerivatives {
 public:
  virtual ~LoadDerivatives() = default;
  virtual void add_by_position(std::size_t i, std::size_t j, const Mat3& k) = 0;
  virtual void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) = 0;
};

/// An external force. Extension point: derive, and hand it to the system. It must be pure in the state it is
/// shown (an adaptive step evaluates six stages and may throw them away), and safe to call from several
/// threads.
class TENDRIL_CORE_API Force {
 public:
  virtual ~Force() = default;

  /// Adds to the loads; never overwrites.
  virtual void add(const StateView& state, const Loads& loads) const = 0;

  /// Called once when a system is made: throws InvalidInput when the force names a rod or node that is not
  /// there.
  virtual void check(std::span<const NodeRange>) const {}

  /// True when the force is minus the gradient of energy(); then the energy balance counts its potential
  /// instead of its work.
  virtual bool has_energy() const { return false; }
  virtual double energy(const StateView&) const { return 0.0; }

  /// The acceleration a, when the loads are the mass of each node times a in every state and at all times,
  /// and nothing else: such forces are summed once when a system is made, add() is not called, and their
  /// energy is -sum m a . p.
  virtual std::optional<Vec3> uniform_acceleration() const { return {}; }

  /// False when the loads are the same whatever the state: implicit steps then need no derivatives of them.
  virtual bool depends_on_state() const { return true; }

  /// True when add_derivatives gives all there are. Otherwise an implicit step takes differences: some fifty
  /// calls of add(), in which a node is taken to feel up to its third neighbours.
  virtual bool has_derivatives() const { return false; }
  virtual void add_derivatives(const StateView&, LoadDerivatives&) const {}

  /// False when the loads are the same at all times.
  virtual bool depends_on_time() const { return true; }

  /// True when it may turn nodes about their tangents: such a scene keeps its twist state.
  virtual bool twists() const { return false; }

  /// Times where it jumps; steps end there.
  virtual std::vector<double> breaks() const { return {}; }
};

}  // namespace tendril
