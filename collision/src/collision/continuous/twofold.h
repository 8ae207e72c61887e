#pragma once

#include <bit>
#include <cstdint>

namespace tendril::collision {

/// Unevaluated sum of two doubles, in any rounding mode [Boldo, Graillat and Muller 2017].
///
/// sum() is off by at most a few 2^-104 of its terms where rounding is directed, and exact to nearest.
/// product() cuts its factors by their bits, so that the four partial products but the least are exact in
/// every mode; the rest is rounded at 2^-104 of it. So one operation is off by less than error = 2^-98 of the
/// sizes that go into it: of |a| + |b| in a sum, of |a b| in a product.
struct Twofold {
  double high = 0.0, low = 0.0;

  static constexpr double error = 0x1p-98;

  static Twofold sum(double a, double b) {
    const double s = a + b, bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
  }
  static Twofold product(double a, double b) {
    const double p = a * b, ah = front(a), bh = front(b), al = a - ah, bl = b - bh;
    return {p, (((ah * bh - p) + ah * bl) + al * bh) + al * bl};
  }

  friend Twofold operator+(const Twofold& a, const Twofold& b) {
    const Twofold s = sum(a.high, b.high);
    return sum(s.high, s.low + (a.low + b.low));
  }
  friend Twofold operator-(const Twofold& a) { return {-a.high, -a.low}; }
  friend Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }
  friend Twofold operator*(const Twofold& a, const Twofold& b) {
    const Twofold p = product(a.high, b.high);
    return sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }

 private:
  /// The first 26 bits.
  static double front(double x) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & ~((std::uint64_t{1} << 27) - 1));
  }
};

}  // namespace tendril::collision
