#include <gtest/gtest.h>
#include <tendril/dynamics/cash_karp.h>

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

}  // namespace
}  // namespace tendril
