#include <gtest/gtest.h>
#include <tendril/scene/output_times.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace tendril::test {
namespace {

TEST(OutputTimes, NoneIsBeyondTheEndWhateverTheDurationAndTheFrames) {
  std::mt19937_64 random(20250907);
  std::uniform_real_distribution<double> exponent(-300.0, 308.0), frames(std::log(2.0), std::log(10000.0));
  int beyond = 0;
  for (int k = 0; k < 100000; ++k) {
    const double duration = k % 2 == 0 ? std::pow(10.0, exponent(random)) : 1e-3 * static_cast<double>(k);
    if (!(duration > 0.0)) continue;
    const auto count = static_cast<std::size_t>(std::exp(frames(random)));
    const std::vector<double> times = scene::output_times(duration, count);
    ASSERT_EQ(times.size(), count);
    ASSERT_EQ(times.front(), 0.0);
    ASSERT_EQ(times.back(), duration);
    ASSERT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<>())) << duration << ", " << count;
    const auto last = static_cast<double>(count - 1);
    if (duration * last / last > duration) ++beyond;
  }
  EXPECT_GT(beyond, 1000);  // what plain quotients would have put behind the end
}

TEST(OutputTimes, NoneIsBeyondTheEndWhateverTheStep) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0), part(1.0, 500.0);
  for (int k = 0; k < 100000; ++k) {
    const double duration = std::pow(10.0, exponent(random));
    const double pieces = k % 2 == 0 ? std::floor(part(random)) : part(random);
    const std::vector<double> times = scene::output_times_every(duration, duration / pieces);
    ASSERT_EQ(times.size(), static_cast<std::size_t>(pieces) + 1) << duration << ", " << pieces;
    ASSERT_EQ(times.front(), 0.0);
    ASSERT_LE(times.back(), duration);
    if (pieces == std::floor(pieces)) ASSERT_EQ(times.back(), duration);
    ASSERT_TRUE(std::is_sorted(times.begin(), times.end(), std::less_equal<>()))
        << duration << ", " << pieces;
  }
}

}  // namespace
}  // namespace tendril::test
