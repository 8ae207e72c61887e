#include <tendril/dynamics/backward_euler.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

MethodInfo backward_euler_method() {
  return {Method::backward_euler, "backward_euler",   1, 1, {kAnyStep, kAnyStep}, true,
          Chooses::nothing,       made<BackwardEuler>};
}

}  // namespace tendril
