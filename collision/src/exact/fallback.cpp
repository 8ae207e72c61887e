#include "exact/fallback.h"

#include "exact/polynomials.h"

// CGAL would else test the rounding modes when the program starts.
#define CGAL_DISABLE_ROUNDING_MATH_CHECK
#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>

#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#ifndef CGAL_HAS_MPZF
#error "tendril::exact needs CGAL's Mpzf: GMP with limbs of 64 bits"
#endif

namespace tendril::exact::fallback {

namespace {

/// A binary fraction of any length: sums and products do not round.
class Unrounded {
 public:
  /// Denormal numbers by their bits: the host may have comparisons take them for zero.
  explicit Unrounded(double x) : value_(denormal(x) ? mantissa(x) : CGAL::Mpzf(x)) {
    if (denormal(x)) value_ = value_ * CGAL::Mpzf(0x1p-1000) * CGAL::Mpzf(0x1p-74);
  }

  friend Unrounded operator+(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ + b.value_);
  }
  friend Unrounded operator-(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ - b.value_);
  }
  friend Unrounded operator*(const Unrounded& a, const Unrounded& b) {
    return Unrounded(a.value_ * b.value_);
  }
  friend int sign(const Unrounded& x) { return static_cast<int>(x.value_.sign()); }
  CGAL::Gmpq rational() const { return static_cast<CGAL::Gmpq>(value_); }

 private:
  static bool denormal(double x) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) << 1;
    return bits != 0 && bits >> 53 == 0;
  }
  static CGAL::Mpzf mantissa(double x) {
    const auto bits = static_cast<long>(std::bit_cast<std::uint64_t>(x) & ((std::uint64_t{1} << 52) - 1));
    return CGAL::Mpzf(std::signbit(x) ? -bits : bits);
  }
  explicit Unrounded(CGAL::Mpzf&& value) : value_(std::move(value)) {}
  CGAL::Mpzf value_;
};

/// m 2^exponent towards 0 or, with `up`, away from it; m below 2^63.
double scaled(std::uint64_t m, int exponent, bool up) {
  const int excess = std::max(0, 64 - std::countl_zero(m) - 53);
  const std::uint64_t low = (std::uint64_t{1} << excess) - 1;
  if (up && (m & low) != 0) m += low + 1;
  const double x = std::ldexp(static_cast<double>(m & ~low), exponent);
  if (std::isinf(x) && !up) return std::numeric_limits<double>::max();
  const bool denormal = x < std::numeric_limits<double>::min();
  return denormal ? std::nextafter(x, up ? 1.0 : 0.0) : x;
}

/// Through the whole number below sqrt(square 4^shift), of 57 to 61 bits.
Bounds root(const CGAL::Gmpq& square) {
  const auto bits = [](const CGAL::Gmpz& z) { return static_cast<int>(mpz_sizeinbase(z.mpz(), 2)); };
  CGAL::Gmpz above = square.numerator(), below = square.denominator();
  const int shift = (118 - bits(above) + bits(below)) / 2;
  CGAL::Gmpz& longer = shift >= 0 ? above : below;
  mpz_mul_2exp(longer.mpz(), longer.mpz(), 2 * static_cast<mp_bitcnt_t>(std::abs(shift)));
  CGAL::Gmpz whole;
  mpz_fdiv_q(whole.mpz(), above.mpz(), below.mpz());
  mpz_sqrt(whole.mpz(), whole.mpz());
  const std::uint64_t m = mpz_get_ui(whole.mpz());
  return {scaled(m, -shift, false), scaled(m + 1, -shift, true)};
}

}  // namespace

int side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) {
  return sign(side_polynomial<Unrounded>(p, q, r, x));
}

int turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) {
  return sign(turn_polynomial<Unrounded>(axis, a, b, c));
}

int compare_distance(Points a, Points b, double radius_a, double radius_b) {
  return exact::compare_distance<Unrounded>(a, b, radius_a, radius_b);
}

Bounds distance(Points a, Points b) {
  std::optional<Fraction<Unrounded>> least;
  for_each_feature<Unrounded>(a, b, [&](const auto& feature) {
    if (feature.valid() != 1) return;
    const Fraction<Unrounded> f = feature.square();
    if (!least || sign(f.above * least->below - least->above * f.below) < 0) least = f;
  });
  return root(least->above.rational() / least->below.rational());
}

}  // namespace tendril::exact::fallback
