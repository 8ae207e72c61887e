#pragma once

#include <tendril/dynamics/rodas.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace tendril::test {

/// Positions after some steps of one size.
inline Eigen::VectorXd after(const System& system, const State& start, Stepper& stepper, double time,
                             int steps) {
  State state = start;
  for (int i = 0; i < steps; ++i)
    if (!stepper.advance(state, time / steps).ok()) throw std::runtime_error("step failed");
  return state.y.head(3 * static_cast<Eigen::Index>(system.node_count()));
}

/// The order at which RODAS converges, from steps halved once against steps 16 times as fine.
inline double order_of(const System& system, const State& start, double time, int coarse) {
  Rodas rodas(system);
  const Eigen::VectorXd reference = after(system, start, rodas, time, 16 * coarse);
  const double first = (after(system, start, rodas, time, coarse) - reference).norm();
  const double second = (after(system, start, rodas, time, 2 * coarse) - reference).norm();
  std::printf("RODAS: errors %.2e %.2e, order %.2f\n", first, second, std::log2(first / second));
  return std::log2(first / second);
}

}  // namespace tendril::test
