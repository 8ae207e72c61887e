#include <tendril/dynamics/cash_karp.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// |R(i y)| of the solution exceeds 1 by y^6 / 7200; 3.73 is where |R(-x)| = 1, rounded down.
MethodInfo cash_karp_method() {
  return {Method::cash_karp, "cash_karp", 6, 5, {0.0, 3.73}, false, Chooses::steps, made<CashKarp>};
}

}  // namespace tendril
