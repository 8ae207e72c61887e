#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace tendril {

struct StateView;

/// Where derivatives of loads are put: of the force on node i by the position and by the velocity of node j
/// (flat indices), a pair that the force's couplings name. A row is a component of the force. Of bodies, see
/// Force::couplings: torques by infinitesimal turns and by spins, too, all in the world.
class TENDRIL_CORE_API LoadDerivatives {
 public:
  virtual ~LoadDerivatives() = default;
  virtual void add_by_position(std::size_t i, std::size_t j, const Mat3& k) = 0;  ///< adds k
  virtual void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) = 0;  ///< adds k
};

/// What the loads of a force depend on, and how they change with it. Implicit steps and equilibria keep room
/// for the pairs of nodes said here, on whatever rods, and for no others. A node's state is its position,
/// velocity, tangent, director and spin; its load is the force and the torque on it.
///
/// Elimination carries a coupling along until its last node: a spring between the ends of a rod widens each
/// of its rows by a block, k nodes that all couple take k^3 / 6 products of blocks a step. What takes more
/// than 2^24 of them (or 64 a node) is refused with InvalidInput by steppers that solve linear equations.
class TENDRIL_CORE_API Couplings {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< of flat indices
  /// Adds the derivatives of the loads at a state.
  using Derivatives = std::function<void(const StateView&, LoadDerivatives&)>;

  /// The loads are the same in every state.
  static Couplings none() { return {}; }
  /// The load on a node moves with the states of the nodes of its rod at most `reach` edges away, 0 being the
  /// node alone.
  static Couplings within(std::size_t reach);
  /// The loads on a pair of nodes, flat indices, move with the states of both; {i, i} is a node alone.
  static Couplings between(std::vector<Pair> pairs);
  /// The loads on these nodes move with the states of all of them.
  static Couplings among(const std::vector<std::size_t>& nodes);

  /// The same with exact derivatives of all loads by all states. Without them differences are taken, some
  /// fifty calls of Force::add for a short reach, and more pairs are kept: those of the neighbours too, which
  /// turn the frames that the force may see. A force that gives torques, or sees tangents, directors or
  /// spins, has no derivatives of this kind.
  Couplings with(Derivatives derivatives) &&;

  bool any() const { return reach_ || !pairs_.empty(); }       ///< the loads depend on the state
  std::optional<std::size_t> reach() const { return reach_; }  ///< what within() was given
  const std::vector<Pair>& pairs() const { return pairs_; }    ///< what between() or among() named
  /// Empty where differences are to be taken.
  const Derivatives& derivatives() const { return derivatives_; }

 private:
  std::optional<std::size_t> reach_;
  std::vector<Pair> pairs_;
  Derivatives derivatives_;
};

}  // namespace tendril
