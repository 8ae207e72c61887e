#pragma once

#include <tendril/dynamics/system.h>

#include <vector>

#include "dynamics/scene/free_bodies.h"

namespace tendril {

/// The book of energy: what there was at first, what came in by work, what there is, and how far that is off,
/// relative to the largest energy seen.
class EnergyBalance {
 public:
  /// Begins at a state.
  /// \param system, work  kept by reference
  EnergyBalance(const System& system, System::Workspace& work, const State& state);

  /// \param own  of it, without the common motions
  void scale_at_least(double energy, double own);

  /// Goes on with another's book, in a scene laid out anew at the same time: what was let go took its energy
  /// along.
  void take_over(const EnergyBalance& before);

  /// Looks at a state, for one evaluation of the forces.
  void look(const State& state) { look(state, system_.energies(state, workspace_)); }
  /// The same where its energies are known.
  void look(const State& state, const Energies& energies);

  /// What a change of the state between two steps puts in counts as work from here on; returns it. For three
  /// evaluations of the forces.
  double change(const State& before, const State& after);

  const Energies& first() const { return first_; }
  const Energies& last() const { return last_; }  ///< where it looked
  double work(const State& state) const { return state.y[state.y.size() - 1] + work_before_; }
  /// How far a state is off, as an energy.
  double off(const State& state, const Energies& energies) const {
    return energies.total() - first_.total() - work(state);
  }
  double scale() const { return scale_; }          ///< the largest energy seen, where it looked
  double imbalance() const { return imbalance_; }  ///< off / the largest energy seen, where it looked

  /// The largest energy of motion seen: kinetic energy, what is in the springs more than at the start, and
  /// what came in by work and out of the potential. Of a body that nothing holds, the energy of the common
  /// motion and what went into it count for nothing: a method loses nothing there, and it would hide what is
  /// lost in the body.
  double own_scale() const { return own_scale_; }
  double own_imbalance() const { return own_scale_ > 0.0 ? off_ / own_scale_ : 0.0; }

 private:
  double common_motion(const State& state) const;

  const System& system_;
  System::Workspace& workspace_;
  std::vector<Tree> free_;
  Energies first_, last_;
  Energies laid_out_;  ///< at the start of this layout
  double laid_out_work_, laid_out_common_;
  double work_before_;  ///< beside that counted in the state
  double scale_ = 0.0, own_scale_ = 0.0, off_ = 0.0, imbalance_ = 0.0;
};

}  // namespace tendril
