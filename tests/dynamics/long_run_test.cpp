#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"

namespace tendril {
namespace {

#ifdef TENDRIL_LONG
constexpr double kDuration = 60.0;
constexpr double kVerletEnergy = 0.05;  // measured 0.034
#else
constexpr double kDuration = 6.0;
constexpr double kVerletEnergy = 0.025;  // measured 0.0193
#endif

/// The undamped rod of 32 masses on which stock Cash-Karp steppers gain 160 times m g L / 2 in 60 s and
/// report success: clamped, horizontal, let go.
struct Swing {
  Swing() : system(scene()), work(system.make_workspace()) {
    for (const double m : system.scene().rods[0].mass) unit += m * 9.81 / 2;
    frequency = system.largest_frequency(system.rest_state(), 16, *work);
  }
  static Scene scene() {
    Scene result;
    result.rods.push_back(test::straight_rod(31, 1e6, 5e-3));
    result.anchors.push_back({0, 0, true, true, {}});
    result.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
    return result;
  }
  /// Largest energy error in units of m g L / 2, of the first and of the second half, at h w = y.
  struct Halves {
    double largest[2] = {0, 0};
    double mean[2] = {0, 0};
  };
  Halves errors(Method method, double y, double duration) const {
    State state = system.rest_state();
    const double before = system.energies(state, *work).total();
    const auto stepper = make_stepper(method, system);
    const long steps = std::lround(duration * frequency / y);
    Halves result;
    for (long i = 0; i < steps; ++i) {
      const double error = (system.energies(state, *work).total() - before) / unit;
      const int half = 2 * i < steps ? 0 : 1;
      result.largest[half] = std::max(result.largest[half], std::abs(error));
      result.mean[half] += 2 * error / static_cast<double>(steps);
      if (!stepper->advance(state, duration / static_cast<double>(steps)).ok() || std::abs(error) > 1e3)
        throw std::runtime_error("energy out of bounds");
    }
    std::printf("%s, h w = %.2f, %.0f s: energy within %.2e and %.2e of mgL/2, means %.1e and %.1e\n",
                stepper->name(), y, duration, result.largest[0], result.largest[1], result.mean[0],
                result.mean[1]);
    return result;
  }
  System system;
  System::WorkspacePtr work;
  double unit = 0.0, frequency = 0.0;
};

TEST(LongUndampedRun, VerletKeepsTheEnergyWithinBounds) {
  const Swing swing;
  const auto half = swing.errors(Method::verlet, 1.0, kDuration);
  EXPECT_LT(half.largest[0], kVerletEnergy);
  EXPECT_LT(half.largest[1], kVerletEnergy);
  const auto quarter = swing.errors(Method::verlet, 0.5, kDuration);
  EXPECT_LT(quarter.largest[1], 0.4 * half.largest[1]);
  EXPECT_LT(std::max(quarter.largest[0], quarter.largest[1]), 0.02);
#ifdef TENDRIL_LONG
  // No drift: what grows with time would double.
  EXPECT_LT(half.largest[1], 1.5 * half.largest[0]);
  EXPECT_LT(std::abs(half.mean[1] - half.mean[0]), 0.1 * half.largest[0]);
#endif
}

TEST(LongUndampedRun, RungeKuttaLosesMoreThanVerletAtTheSameStepAndLessAtASmallOne) {
  const Swing swing;
  const auto verlet = swing.errors(Method::verlet, 1.0, 6.0);
  const auto coarse = swing.errors(Method::runge_kutta4, 1.0, 6.0);
  EXPECT_GT(coarse.largest[1], 5 * verlet.largest[1]);
  EXPECT_LT(coarse.mean[1], -0.1);
  EXPECT_LT(swing.errors(Method::runge_kutta4, 0.2, 3.0).largest[1],
            swing.errors(Method::verlet, 0.2, 3.0).largest[1]);
  EXPECT_THROW(swing.errors(Method::explicit_euler, 0.2, 3.0), std::runtime_error);
}

TEST(LongUndampedRun, CashKarpKeepsTheEnergyOrSaysWhen) {
  const Swing swing;
  Simulation simulation(swing.system, swing.system.rest_state());
  const Report report = simulation.run(kDuration);
  const double error = (report.last.total() - report.first.total()) / swing.unit;
  std::printf("%s, %.0f s: %s, energy %.2e of mgL/2, %ld evaluations %s\n", report.method.c_str(), kDuration,
              to_string(report.stop), error, report.evaluations, report.reason.c_str());
#ifdef TENDRIL_LONG
  EXPECT_EQ(report.stop, Stop::energy_lost);
  EXPECT_GT(report.time, 30.0);
#else
  EXPECT_EQ(report.stop, Stop::finished);
  EXPECT_LT(std::abs(error), 5e-3);
#endif
}

}  // namespace
}  // namespace tendril
