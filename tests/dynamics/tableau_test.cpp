#include <gtest/gtest.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/nystrom.h>

#include <cmath>
#include <numeric>

namespace tendril {
namespace {

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

using Four = std::array<double, 4>;

Four power(int k) {
  Four out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = k == 0 ? 1.0 : std::pow(NystromTableau::c[i], k);
  return out;
}
double dot(const Four& a, const Four& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
Four times(const Four& a, const Four& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]};
}
Four after(const std::array<std::array<double, 3>, 4>& rows, const Four& x) {
  Four out{};
  for (std::size_t i = 0; i < 4; ++i)
    out[i] = std::inner_product(rows[i].begin(), rows[i].end(), x.begin(), 0.0);
  return out;
}

// [Hairer et al. 1993] II.14; the weights of places follow from those of rates.
TEST(NystromTableau, MeetsTheConditionsOfOrderFiveForForcesThatDependOnPlaces) {
  using T = NystromTableau;
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(after(T::place, power(0))[i], T::c[i] * T::c[i] / 2, 1e-15) << i;
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(dot(T::b, power(k)), 1.0 / (k + 1), 1e-15) << k;
  EXPECT_NEAR(dot(T::b, after(T::place, power(1))), 1.0 / 24, 1e-15);
  EXPECT_NEAR(dot(times(T::b, power(1)), after(T::place, power(1))), 1.0 / 30, 1e-15);
  EXPECT_NEAR(dot(T::b, after(T::place, power(2))), 1.0 / 60, 1e-15);
}

TEST(NystromTableau, MeetsAllButOneConditionOfOrderFourForForcesThatDependOnRates) {
  using T = NystromTableau;
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(after(T::rate, power(0))[i], T::c[i], 1e-15) << i;
  EXPECT_NEAR(dot(T::b, after(T::rate, power(1))), 1.0 / 6, 1e-15);
  EXPECT_NEAR(dot(times(T::b, power(1)), after(T::rate, power(1))), 1.0 / 8, 1e-15);
  EXPECT_NEAR(dot(T::b, after(T::rate, power(2))), 1.0 / 12, 1e-15);
  EXPECT_NEAR(dot(T::b, after(T::rate, after(T::rate, power(1)))), 1.0 / 60, 1e-15);
}

TEST(NystromTableau, TakesItsErrorFromTheThirdDividedDifference) {
  using T = NystromTableau;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(dot(T::difference, power(k)), 0.0, 1e-14) << k;
  EXPECT_NEAR(dot(T::difference, power(3)), 1.0, 1e-14);
}

}  // namespace
}  // namespace tendril
