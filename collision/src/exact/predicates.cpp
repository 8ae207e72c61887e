#include "exact/predicates.h"

#include <algorithm>
#include <array>

#include "exact/fallback.h"

namespace tendril::exact {

namespace {

__extension__ using Wide = __int128;
using Integers = std::array<std::int64_t, 3>;

/// Points in units of 2^-60 of a power of two above them all, where those are whole numbers: then below 2^60.
/// Ordinary numbers only, so that the scale is one too; no operation here rounds.
template <std::size_t n>
bool to_integers(const std::array<const Vec3*, n>& points, std::array<Integers, n>& out) {
  std::uint64_t most = 0;
  for (const Vec3* p : points)
    for (const double x : *p) most = std::max(most, std::bit_cast<std::uint64_t>(x) << 1);
  if (most == 0) return false;
  // |x| < 2^(exponent - 1022), and 2^60 over that has the exponent below.
  const double scale = std::bit_cast<double>((std::uint64_t{1023 + 1022 + 60} - (most >> 53)) << 52);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = (*points[i])[static_cast<Eigen::Index>(k)] * scale;
      out[i][k] = static_cast<std::int64_t>(x);
      if (static_cast<double>(out[i][k]) != x) return false;
    }
  return true;
}

Integers minus(const Integers& a, const Integers& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Coordinate k of a x b, of vectors below 2^61: below 2^123.
Wide cross(const Integers& a, const Integers& b, std::size_t k) {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  return Wide{a[i]} * b[j] - Wide{a[j]} * b[i];
}

int sign(Wide x) {
  return int(x > 0) - int(x < 0);
}

/// The sign of (a x b) . c: the products' upper and lower 64 bits summed apart, each sum below 2^127.
int sign_of_determinant(const Integers& a, const Integers& b, const Integers& c) {
  Wide high = 0, low = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Wide n = cross(a, b, k);
    high += (n >> 64) * c[k];
    low += Wide{static_cast<std::uint64_t>(n)} * c[k];
  }
  high += low >> 64;
  return high != 0 ? sign(high) : int(static_cast<std::uint64_t>(low) != 0);
}

}  // namespace

int Predicates::slow_side(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) const {
  std::array<Integers, 4> i;
  if (ordinary_ && to_integers<4>({&p, &q, &r, &x}, i))
    return sign_of_determinant(minus(i[1], i[0]), minus(i[2], i[0]), minus(i[3], i[0]));
  return fallback::side(p, q, r, x);
}

int Predicates::slow_turn(int axis, const Vec3& a, const Vec3& b, const Vec3& c) const {
  std::array<Integers, 3> i;
  if (ordinary_ && to_integers<3>({&a, &b, &c}, i))
    return sign(cross(minus(i[1], i[0]), minus(i[2], i[0]), static_cast<std::size_t>(axis)));
  return fallback::turn(axis, a, b, c);
}

}  // namespace tendril::exact
