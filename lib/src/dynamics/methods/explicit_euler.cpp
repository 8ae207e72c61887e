#include <tendril/dynamics/fixed_steppers.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// |R(i y)| exceeds 1 by y^2 / 2.
MethodInfo explicit_euler_method() {
  return {Method::explicit_euler, "explicit_euler",   1, 1, {0.0, 2.0}, false,
          Chooses::nothing,       made<ExplicitEuler>};
}

}  // namespace tendril
