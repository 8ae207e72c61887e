#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

/// Intervals whose ends are moved outward after every operation, in any rounding mode.
///
/// Why this holds: an operation on doubles returns a neighbour of the exact result, less than one unit in the
/// last place ulp(x) of the returned x away (or one subnormal step). |x| 2^-52 lies in [ulp(x), 2 ulp(x)), so
/// x - |x| 2^-52 rounds to no more than x - ulp(x), which is a double and below the exact result; the
/// smallest normal number does the same for subnormal x. Upward alike.
namespace tendril::collision {

struct Interval {
  double low, high;

  double middle() const { return 0.5 * (low + high); }
  double most() const { return std::max(std::abs(low), std::abs(high)); }
};

inline Interval outward(double low, double high) {
  constexpr double step = std::numeric_limits<double>::epsilon();
  constexpr double least = std::numeric_limits<double>::min();
  return {low - (std::abs(low) * step + least), high + (std::abs(high) * step + least)};
}

inline Interval operator+(const Interval& a, const Interval& b) {
  return outward(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a, const Interval& b) {
  return outward(a.low - b.high, a.high - b.low);
}
inline Interval operator*(const Interval& a, const Interval& b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
/// \param b  above 0
inline Interval operator/(const Interval& a, const Interval& b) {
  return outward(std::min(a.low / b.low, a.low / b.high), std::max(a.high / b.low, a.high / b.high));
}

/// 1 / sqrt(1 + a^2 + b^2)
inline Interval inverse_length(const Interval& a, const Interval& b) {
  const auto least = [](const Interval& x) { return x.low > 0.0 ? x.low : x.high < 0.0 ? -x.high : 0.0; };
  const Interval aa = Interval{least(a), a.most()} * Interval{least(a), a.most()};
  const Interval bb = Interval{least(b), b.most()} * Interval{least(b), b.most()};
  const Interval square = Interval{1.0, 1.0} + aa + bb;
  const Interval root = outward(std::sqrt(square.low), std::sqrt(square.high));
  const Interval inverse = Interval{1.0, 1.0} / root;
  return {inverse.low, std::min(inverse.high, 1.0)};
}

}  // namespace tendril::collision
