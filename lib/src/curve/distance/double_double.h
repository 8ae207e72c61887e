#pragma once

#include <cmath>

namespace tendril {

/// Unevaluated sum of two doubles, about 106 bits [Dekker 1971]. For the few sub-pieces whose slopes a double
/// cannot sign.
///
/// Errors, u = 2^-53, |low| <= u |high|. sum() is exact ([Knuth 1997] 4.2.2). In a + b two numbers of at most
/// u (|a| + |b|) each are added with roundings: 3 u^2 (|a| + |b|), relative to the sizes, not to the sum,
/// which may cancel. In a b the product of the lows is left out, u^2 |a b|; the two cross terms are rounded,
/// u^2 each, and their sum, 2 u^2; and its sum with the error of a.high b.high, which fma gives exactly, 3
/// u^2: in all 8 u^2 |a b| = 2^-103 |a b|. `unit_of` is 2^-102 for each.
struct DoubleDouble {
  double high = 0.0, low = 0.0;

  DoubleDouble() = default;
  DoubleDouble(double x) : high(x) {}  // NOLINT(google-explicit-constructor): a double is one
  DoubleDouble(double h, double l) : high(h), low(l) {}

  static DoubleDouble sum(double a, double b) {
    const double s = a + b, bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
  }
  friend DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble s = sum(a.high, b.high);
    return sum(s.high, s.low + (a.low + b.low));
  }
  friend DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + (-b); }
  friend DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const double p = a.high * b.high;
    return sum(p, std::fma(a.high, b.high, -p) + (a.high * b.low + a.low * b.high));
  }
  friend DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double q = a.high / b.high;
    const DoubleDouble rest = a - b * DoubleDouble(q);
    const double q2 = rest.high / b.high;
    const DoubleDouble last = rest - b * DoubleDouble(q2);
    return DoubleDouble(q) + DoubleDouble(q2) + DoubleDouble(last.high / b.high);
  }
  DoubleDouble& operator+=(DoubleDouble b) { return *this = *this + b; }
};

inline double to_double(double x) {
  return x;
}
inline double to_double(DoubleDouble x) {
  return x.high;
}

/// Relative error of one operation.
template <class T>
inline constexpr double unit_of = 0x1p-53;
template <>
inline constexpr double unit_of<DoubleDouble> = 0x1p-102;

}  // namespace tendril
