#pragma once

#include <tendril/contact/law.h>

namespace tendril::contact {

/// Of some stiffness, as soft as the tests' rods are thick.
inline Law law_of(Law::Kind kind, double range, double friction, double damping) {
  return {.kind = kind,
          .stiffness = 300.0,
          .range = range,
          .friction = friction,
          .stick_damping = damping,
          .damping = damping};
}

}  // namespace tendril::contact
