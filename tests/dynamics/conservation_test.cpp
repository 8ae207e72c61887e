#include <gtest/gtest.h>
#include <tendril/dynamics/cash_karp.h>

#include <numeric>

#include "support/free_flight.h"

namespace tendril {
namespace {

using test::FreeFlight;

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

TEST(FreeFlight, KeepsEnergyAndBothMomenta) {
  const FreeFlight flight;
  ASSERT_EQ(flight.system.twist_count(), 8u);
  const auto work = flight.system.make_workspace();
  const test::Momentum before = test::momentum(flight.system, flight.state);
  const double energy = flight.system.energies(flight.state, *work).total();
  const State end = flight.run(Method::cash_karp, 2000);
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
  const auto positions = [&](int steps) {
    return Eigen::VectorXd(flight.run(Method::cash_karp, steps).y.head(24));
  };
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
