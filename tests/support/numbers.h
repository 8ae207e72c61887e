#pragma once

#include <limits>
#include <numbers>

/// Numbers that many tests name.
namespace tendril::test {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kGravity = 9.81;

}  // namespace tendril::test
