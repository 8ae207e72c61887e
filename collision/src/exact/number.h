#pragma once

#include <tendril/base/types.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace tendril::exact {

/// What a sign function returns where its arithmetic cannot tell.
inline constexpr int kUnknown = 2;

/// A bound of the relative error of one operation in any rounding mode, as long as nothing underflows.
inline constexpr double kEps = 0x1p-52;

/// Ordinary: each number is 0 or 2^-100 to 2^100 in size. A difference of two is then 0 or at least 2^-152,
/// so that no product of six differences, nor the square of a bound of one of three, leaves the range of
/// normal doubles: the filters need not think of underflow, and not of hosts that flush denormals to zero.
/// Extreme is all else that is finite.
enum class Range { ordinary, extreme, not_finite };

/// By the bits, so that no rounding or flushing takes part.
inline Range range_of(std::initializer_list<Points> groups) {
  std::uint64_t least = 2046, most = 0;
  for (const Points points : groups) {
    const double* x = points.data()->data();
    for (std::size_t i = 0; i < 3 * points.size(); ++i) {
      const std::uint64_t bits = std::bit_cast<std::uint64_t>(x[i]) << 1;
      const std::uint64_t exponent = bits >> 53;
      most = exponent > most ? exponent : most;
      const std::uint64_t small = bits == 0 ? 1023 : exponent;
      least = small < least ? small : least;
    }
  }
  if (most == 2047) return Range::not_finite;
  return least < 1023 - 100 || most > 1023 + 99 ? Range::extreme : Range::ordinary;
}
inline Range range_of(double x) {
  const Vec3 v = Vec3::Constant(x);
  return range_of({Points(&v, 1)});
}

/// -1, 0, 1 as a < b, a = b, a > b, by the bits.
inline int compare(double a, double b) {
  const auto key = [](double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits < 0 ? INT64_MIN - bits : bits;
  };
  return int(key(a) > key(b)) - int(key(a) < key(b));
}

/// Coordinate by coordinate: an order along every line.
inline int compare(const Vec3& a, const Vec3& b) {
  for (int k = 0; k < 3; ++k)
    if (const int c = compare(a[k], b[k])) return c;
  return 0;
}

/// A double with a bound of its error: |value - true value| <= error, whatever the rounding mode. Each new
/// bound is a sum of positive terms, at most five operations deep, so too small by at most (1 - eps)^5: the
/// factor makes up for it. For ordinary numbers only.
class Bounded {
 public:
  Bounded() = default;
  explicit Bounded(double exact) : value_(exact) {}

  double value() const { return value_; }
  double error() const { return error_; }

  friend Bounded operator+(const Bounded& a, const Bounded& b) {
    return rounded(a.value_ + b.value_, a.error_ + b.error_);
  }
  friend Bounded operator-(const Bounded& a, const Bounded& b) {
    return rounded(a.value_ - b.value_, a.error_ + b.error_);
  }
  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    return rounded(a.value_ * b.value_,
                   std::abs(a.value_) * b.error_ + a.error_ * (std::abs(b.value_) + b.error_));
  }

 private:
  static Bounded rounded(double value, double error) {
    Bounded result(value);
    result.error_ = (error + kEps * std::abs(value)) * (1 + 8 * kEps);
    return result;
  }
  double value_ = 0.0, error_ = 0.0;
};

inline int sign(const Bounded& x) {
  if (x.value() > x.error()) return 1;
  if (x.value() < -x.error()) return -1;
  return x.error() == 0.0 ? 0 : kUnknown;
}

}  // namespace tendril::exact
