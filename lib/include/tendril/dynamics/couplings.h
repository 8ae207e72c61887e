#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace tendril {

struct StateView;
struct Loads;

/// Where derivatives of loads are put: of the force on node i by the position and by the velocity of node j
/// (flat indices), a pair that the force's couplings name. A row is a component of the force. Of bodies, see
/// Force::couplings: torques by infinitesimal turns and by spins, too, all in the world.
class TENDRIL_CORE_API LoadDerivatives {
 public:
  virtual ~LoadDerivatives() = default;
  virtual void add_by_position(std::size_t i, std::size_t j, const Mat3& k) = 0;  ///< adds k
  virtual void add_by_velocity(std::size_t i, std::size_t j, const Mat3& k) = 0;  ///< adds k
};

/// What of a force acts at a state, where few of the pairs that its couplings name do: contact.
struct LocalCouplings {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< that couple there, some of those named
  /// The force's loads at states within 1e-5 of the longest edge and 1e-5 rad of it, what does not act at
  /// the state left out: cheaper than Force::add, which serves where there is none. Called before the next
  /// state is asked for.
  std::function<void(const StateView&, const Loads&)> add;
};

/// What the loads of a force depend on, and how they change with it. Implicit steps and equilibria keep room
/// for the pairs of nodes said here, on whatever rods, and for no others. A node's state is its position,
/// velocity, tangent, director and spin; its load is the force and the torque on it.
///
/// Elimination carries a coupling along until its last node: a spring between the ends of a rod widens each
/// of its rows by a block, k nodes that all couple take k^3 / 6 products of blocks a step. What takes more
/// than 2^24 of them (or 64 a node) is refused with InvalidInput by steppers that solve linear equations; of
/// forces that say at_states(), by those of the state alone, as a failed evaluation.
class TENDRIL_CORE_API Couplings {
 public:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< of flat indices
  /// Adds the derivatives of the loads at a state.
  using Derivatives = std::function<void(const StateView&, LoadDerivatives&)>;
  /// Says what acts at a state, to which the loads at states beside it then keep.
  using Local = std::function<LocalCouplings(const StateView&)>;

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

  /// The same, of which those that act are said at each state: implicit steps and equilibria keep room for
  /// them alone.
  Couplings at_states(Local local) &&;

  bool any() const { return reach_ || !pairs_.empty(); }       ///< the loads depend on the state
  std::optional<std::size_t> reach() const { return reach_; }  ///< what within() was given
  const std::vector<Pair>& pairs() const { return pairs_; }    ///< what between() or among() named
  /// Empty where differences are to be taken.
  const Derivatives& derivatives() const { return derivatives_; }
  /// Empty where all that are named may act at any state.
  const Local& local() const { return local_; }

 private:
  std::optional<std::size_t> reach_;
  std::vector<Pair> pairs_;
  Derivatives derivatives_;
  Local local_;
};

}  // namespace tendril
