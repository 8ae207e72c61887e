#include <tendril/dynamics/rodas.h>

#include "dynamics/steppers/method_row.h"

namespace tendril {

MethodInfo rodas_method() {
  return {Method::rodas, "rodas", 6, 4, {kAnyStep, kAnyStep}, true, Chooses::steps, made<Rodas>};
}

}  // namespace tendril
