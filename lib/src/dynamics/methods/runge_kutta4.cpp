#include <tendril/dynamics/fixed_steppers.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// The roots of |R(i y)| = 1 and |R(-x)| = 1, rounded down.
MethodInfo runge_kutta4_method() {
  return {Method::runge_kutta4, "runge_kutta4",         4, 4, {2.82, 2.78}, false,
          Chooses::nothing,     made<ClassicRungeKutta>};
}

}  // namespace tendril
