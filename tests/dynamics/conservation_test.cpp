#include <gtest/gtest.h>
#include <tendril/dynamics/cash_karp.h>

#include <numeric>

#include "support/rods.h"

namespace tendril {
namespace {

using test::Random;

TEST(CashKarpTableau, MeetsTheOrderConditions) {
  using T = CashKarpTableau;
  for (std::size_t s = 0; s < 6; ++s)
    EXPECT_NEAR(std::accumulate(T::b[s].begin(), T::b[s].end(), 0.0), T::a[s], 1e-15) << s;
  // Quadrature conditions: sum c a^k = 1 / (k + 1), to order 5 and 4.
  for (int k = 0; k < 5; ++k) {
    double five = 0.0;
    double four = 0.0;
    for (std::size_t s = 0; s < 6; ++s) {
      const double power = k == 0 ? 1.0 : std::pow(T::a[s], k);
      five += T::c[s] * power;
      four += T::c_star[s] * power;
    }
    EXPECT_NEAR(five, 1.0 / (k + 1), 1e-15) << k;
    if (k < 4) EXPECT_NEAR(four, 1.0 / (k + 1), 1e-15) << k;
  }
}

/// A free rod, curved at rest, thrown with spin and rotation.
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
  State run(int steps) const {
    State now = state;
    CashKarp stepper(system);
    for (int i = 0; i < steps; ++i)
      if (!stepper.advance(now, 1.0 / steps).ok()) throw std::runtime_error("step failed");
    return now;
  }
  System system;
  State state;
};

TEST(FreeFlight, KeepsEnergyAndBothMomenta) {
  const FreeFlight flight;
  ASSERT_EQ(flight.system.twist_count(), 8u);
  const auto work = flight.system.make_workspace();
  const test::Momentum before = test::momentum(flight.system, flight.state);
  const double energy = flight.system.energies(flight.state, *work).total();
  const State end = flight.run(2000);
  const test::Momentum after = test::momentum(flight.system, end);
  const double drift = std::abs(flight.system.energies(end, *work).total() / energy - 1);
  const double linear = (after.linear - before.linear).norm() / before.linear.norm();
  const double angular = (after.angular - before.angular).norm() / before.angular.norm();
  RecordProperty("energy_drift", std::to_string(drift));
  std::printf("free flight, 1 s, 2000 steps: energy %.2e, linear momentum %.2e, angular momentum %.2e\n",
              drift, linear, angular);
  EXPECT_LT(drift, 1e-8);
  EXPECT_LT(linear, 1e-14);
  EXPECT_LT(angular, 1e-10);
}

TEST(FreeFlight, ConvergesAtOrderFive) {
  const FreeFlight flight;
  const auto positions = [&](int steps) { return Eigen::VectorXd(flight.run(steps).y.head(24)); };
  const Eigen::VectorXd reference = positions(3200);
  const int steps[] = {200, 280, 400};
  double error[3];
  for (int i = 0; i < 3; ++i) error[i] = (positions(steps[i]) - reference).norm();
  for (int i = 0; i < 2; ++i) {
    const double order =
        std::log(error[i] / error[i + 1]) / std::log(static_cast<double>(steps[i + 1]) / steps[i]);
    std::printf("steps %d: error %.3e, order %.2f\n", steps[i], error[i], order);
    EXPECT_NEAR(order, 5.0, 0.3);
  }
}

}  // namespace
}  // namespace tendril
