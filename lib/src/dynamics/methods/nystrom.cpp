#include <tendril/dynamics/nystrom.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// Where an oscillation is first amplified, and |1 - x + x^2 / 2 - x^3 / 6 + x^4 / 60| = 1, rounded down.
MethodInfo nystrom_method() {
  return {Method::nystrom, "nystrom", 4, 5, {2.86, 3.47}, false, Chooses::steps, made<Nystrom>};
}

}  // namespace tendril
