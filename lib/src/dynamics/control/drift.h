#pragma once

#include <tendril/dynamics/system.h>

#include <algorithm>
#include <vector>

#include "dynamics/scene/free_bodies.h"
#include "energy_balance.h"

namespace tendril {

/// How far a motion has drifted off by what its method loses or gains. A tree that moves with speed v in
/// itself and has lost the share e of its energy is slower by e / 2: it lags behind by e v / 2 a time unit,
/// at most by as much as it moves at all. Held against references, of hinged, spinning and clamped rods that
/// is 0.9 to 1.6 times their error. Where nothing turns a tree but gravity, its angular momentum about its
/// centre tells the same.
class Drift {
 public:
  /// Begins at a state.
  /// \param system  kept by reference
  Drift(const System& system, const State& state);

  /// Goes on from another's drift, in a scene laid out anew.
  void take_over(const Drift& before);

  /// Looks at a state.
  /// \param imbalance  of the energy there, relative
  void look(const State& state, double imbalance);

  /// Forgets the angular momenta, which a change of the state has changed.
  void begin_anew(const State& state);

  double lag() const;                          ///< of the tree that is off most, in its longest rod's lengths
  bool by_turning() const;                     ///< told by an angular momentum
  double fastest() const { return fastest_; }  ///< largest speed so far, in lengths a time unit
  double widest() const;                       ///< the largest way from where a tree began, in its lengths

 private:
  struct Moved {
    double length = 0.0;
    double by_energy = 0.0, by_turning = 0.0;  ///< lags
    double way = 0.0;                          ///< largest, in lengths
    Vec3 turning = Vec3::Zero();               ///< angular momentum at the start
    double most_turning = 0.0;
    double lag() const { return std::min(std::max(by_energy, by_turning), way); }
  };
  struct Motion;
  Motion motion(const Tree& tree, const State& state) const;

  const System& system_;
  std::vector<Tree> trees_;
  std::vector<Moved> moved_;
  Eigen::VectorXd start_;  ///< y
  double time_;
  bool untouched_;  ///< but by gravity
  double fastest_ = 0.0;
};

}  // namespace tendril
