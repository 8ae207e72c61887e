#pragma once

#include <tendril/dynamics/system.h>

namespace tendril {

/// The book of energy: what there was at first, what came in by work, what there is, and how far that is off,
/// relative to the largest energy seen.
class EnergyBalance {
 public:
  /// Begins at a state.
  /// \param system, work  kept by reference
  EnergyBalance(const System& system, System::Workspace& work, const State& state);

  void scale_at_least(double energy) { scale_ = energy > scale_ ? energy : scale_; }

  /// Goes on with another's book, in a scene laid out anew at the same time: what was let go took its energy
  /// along.
  void take_over(const EnergyBalance& before);

  /// Looks at a state, for one evaluation of the forces.
  void look(const State& state);

  /// What a change of the state between two steps puts in counts as work from here on; returns it. For three
  /// evaluations of the forces.
  double change(const State& before, const State& after);

  const Energies& first() const { return first_; }
  const Energies& last() const { return last_; }  ///< where it looked
  double work(const State& state) const { return state.y[state.y.size() - 1] + work_before_; }
  double imbalance() const { return imbalance_; }  ///< (last - first - work) / largest energy seen

 private:
  const System& system_;
  System::Workspace& workspace_;
  Energies first_, last_;
  double work_before_;  ///< beside that counted in the state
  double scale_ = 0.0, imbalance_ = 0.0;
};

}  // namespace tendril
