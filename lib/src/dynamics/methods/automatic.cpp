#include <tendril/dynamics/cash_karp.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

// The row of Cash-Karp, with which it begins.
MethodInfo automatic_method() {
  return {Method::automatic, "automatic", 6, 5, {0.0, 3.73}, false, Chooses::method, made<CashKarp>};
}

}  // namespace tendril
