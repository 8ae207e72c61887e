#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

namespace tendril {

/// v' = v + h a(t', p', v'), p' = p + h v', the spins and directors alike. Order 1, stable at every step and
/// strongly dissipating: a comparator.
///
/// Newton on the 3n + m new velocities and spins with a dense matrix from forward differences: 3n + m
/// evaluations and 2/3 (3n + m)^3 operations whenever the kept one converges slowly, 2 (3n + m)^2 operations
/// an iteration; any force and any tree, but not for many nodes. Outcome not_converged when no renewed matrix
/// helps: then a shorter step will.
class TENDRIL_CORE_API BackwardEuler : public Stepper {
 public:
  /// \param system  kept by reference
  explicit BackwardEuler(const System& system);
  ~BackwardEuler() override;
  Evaluation advance(State& state, double h) override;
  void restart() override;
  long evaluations() const override;
  const char* name() const override { return "backward Euler"; }

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril
