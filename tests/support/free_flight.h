#pragma once

#include <tendril/dynamics/method.h>

#include <stdexcept>

#include "support/rods.h"

namespace tendril::test {

/// A free rod of 8 masses, curved at rest, thrown with spin and rotation, for one second.
struct FreeFlight {
  FreeFlight() : system(scene()), state(thrown()) {}

  static Scene scene() {
    std::vector<Vec3> p;
    for (int i = 0; i < 8; ++i) p.emplace_back(0.15 * i, 0.3 * std::cos(0.4 * i), 0.1 * std::sin(0.7 * i));
    Scene result;
    result.rods.push_back(make_rod(p, orientation_towards(p, Vec3(0.1, 0.2, 1), 0.1), {2e4, 8e3, 1000},
                                   elliptic_section(0.05, 0.03)));
    // A heavy flywheel at each node: the gyroscopic force matters.
    for (double& inertia : result.rods[0].inertia) inertia *= 20;
    return result;
  }
  State thrown() const {
    State start = system.rest_state();
    for (std::size_t i = 0; i < 8; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      start.y.segment<3>(24 + 3 * k) =
          Vec3(0.3, -0.2, 0.5) + Vec3(1.0, 2.0, -0.5).cross(test::at(start.y, i));
      start.y[48 + 8 + k] = 6.0 + 0.5 * std::sin(1.0 * static_cast<double>(i));
    }
    return start;
  }
  State run(Stepper& stepper, int steps) const {
    State now = state;
    for (int i = 0; i < steps; ++i)
      if (!stepper.advance(now, 1.0 / steps).ok()) throw std::runtime_error("step failed");
    return now;
  }
  State run(Method method, int steps) const { return run(*make_stepper(method, system), steps); }

  System system;
  State state;
};

}  // namespace tendril::test
