#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/stepper.h>

namespace tendril {

/// v' = v + h a(t', p', v'), p' = p + h v', the spins and directors alike. Order 1, stable at every step and
/// strongly dissipating: a comparator.
///
/// Newton on the 3n + m new velocities and spins with a dense matrix from central differences: 2 (3n + m)
/// evaluations and 2/3 (3n + m)^3 operations whenever the kept one converges slowly, 2 (3n + m)^2 operations
/// an iteration; any force and any tree, but not for many nodes. Of several roots it takes the one that a
/// step growing from 0 leads to: where Newton fails, or turns an edge by over 60 degrees, it gets there in
/// parts. Outcome not_converged when parts of 1/512 fail too: then a shorter step may help.
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
