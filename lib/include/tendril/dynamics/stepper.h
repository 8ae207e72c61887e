#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/system.h>

#include <memory>

namespace tendril {

/// Something that moves a state by one step of a size it is told. Extension point: derive, advance by any
/// rule over System::derivative, end with System::rebase.
class TENDRIL_CORE_API Stepper {
 public:
  virtual ~Stepper() = default;

  /// From state.time to state.time + h, frames renewed. On failure the state is not to be used.
  virtual Evaluation advance(State& state, double h) = 0;

  /// Forgets what it kept from the last step: call when the state has changed other than by advance, or when
  /// a force jumps between two steps.
  virtual void restart() {}

  virtual long evaluations() const = 0;  ///< of the equations, so far
  virtual const char* name() const = 0;  ///< in words
};

/// A stepper that estimates its own error, so that a run can choose its steps.
class TENDRIL_CORE_API EmbeddedStepper : public Stepper {
 public:
  /// From `state` over h: the solution into `y`, and an estimate of its error into `error`, laid out like y.
  /// The state is not changed; what was evaluated there is kept for further tries from the same state. On
  /// failure y and error are not to be used.
  virtual Evaluation step(const State& state, double h, Eigen::VectorXd& y, Eigen::VectorXd& error) = 0;

  /// The last step was taken: the next one begins at its end, with the frames renewed.
  virtual void go_on() { restart(); }

  virtual int error_order() const = 0;          ///< the error goes with h to this order plus 1
  virtual bool stiff() const { return false; }  ///< damps what it does not resolve, at any step
  /// Takes energy out of what it resolves: a run holds what each step puts the balance off by against what
  /// may be lost.
  virtual bool dissipates() const { return stiff(); }

  /// Evaluations a step, of one that is not stiff.
  virtual int stages() const { return 6; }
  /// By how much more than 1 a step of one that is not stiff multiplies x'' + (alpha + beta w^2) x' + w^2 x
  /// = 0 at most: the guard of a run caps its steps by that (stability.h). Cash-Karp's unless overridden.
  virtual double growth(double w, double alpha, double beta, double h) const;
};

}  // namespace tendril
