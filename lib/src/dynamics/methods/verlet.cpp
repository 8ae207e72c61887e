#include <tendril/dynamics/fixed_steppers.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// In a pure decay it multiplies by 1 - x + x^2 / 2 a step, as its kick uses the velocities before the second
// one.
MethodInfo verlet_method() {
  return {Method::verlet, "verlet", 1, 2, {2.0, 2.0}, false, Chooses::nothing, made<VelocityVerlet>};
}

}  // namespace tendril
