#pragma once

#include <tendril/base/types.h>

#include <cstdint>

namespace tendril::test {

/// SplitMix64: the same numbers on every machine and library, unlike the standard distributions. Two draws
/// in one expression may come in either order, so each has a statement of its own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1.0p-53);
  }
  int integer(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  /// Uniform in the cube [-half, half)^3.
  Vec3 in_cube(double half = 1.0) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return Vec3(x, y, uniform(-half, half));
  }

 private:
  std::uint64_t state_;
};

}  // namespace tendril::test
