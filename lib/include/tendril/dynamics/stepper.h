#pragma once

#include <tendril/dynamics/system.h>

#include <memory>

namespace tendril {

/// Something that moves a state by one step of a size it is told. Extension point: derive, advance by any
/// rule over System::derivative, end with System::rebase.
class Stepper {
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

/// The methods a run can be told to use. Cash-Karp chooses its own steps; the others keep to the size given.
enum class Method { cash_karp, verlet, runge_kutta4, explicit_euler, backward_euler };
const char* to_string(Method method);

/// \param system  kept by reference
std::unique_ptr<Stepper> make_stepper(Method method, const System& system);

}  // namespace tendril
