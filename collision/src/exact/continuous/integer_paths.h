#pragma once

#include <tendril/collision/continuous.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "polynomial.h"

namespace tendril::exact {

/// x = mantissa 2^exponent with an odd mantissa, or 0.
struct Parts {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

inline Parts parts(double x) {
  if (x == 0.0) return {};
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(0x1p53 * std::frexp(x, &exponent));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa / (std::int64_t{1} << zeros), exponent - 53 + zeros};
}

__extension__ using Wide = __int128;

/// p q, added to a sum.
template <class Number, std::size_t M, std::size_t N>
void add_product(const std::array<Number, M>& p, const std::array<std::int64_t, N>& q, int sign,
                 std::array<Wide, M + N - 1>& sum) {
  for (std::size_t i = 0; i < M; ++i)
    for (std::size_t j = 0; j < N; ++j) sum[i + j] += sign * static_cast<Wide>(p[i]) * q[j];
}

template <std::size_t N>
Polynomial polynomial(const std::array<Wide, N>& c) {
  Polynomial p{static_cast<int>(N) - 1, {}};
  std::copy(c.begin(), c.end(), p.c.begin());
  return p;
}

/// The paths of the other three vertices relative to the first: d[i][axis]. Each axis is scaled by a power of
/// two of its own, which changes no answer. Most queries that doubles leave open are of numbers with few
/// bits: their products fit machine integers.
template <int Degree>
class IntegerPaths {
 public:
  explicit IntegerPaths(const collision::Paths<Degree>& paths) {
    for (int axis = 0; axis < 3; ++axis) set_axis(paths, axis);
  }

  const Polynomial& at(int which, int axis) const { return d_[which][axis]; }

  /// Of vertices that stay where these begin.
  IntegerPaths beginning() const {
    IntegerPaths out = *this;
    out.bits_ = kAny;
    for (auto& d : out.d_)
      for (Polynomial& p : d) p.degree = 0;
    return out;
  }

  /// d_first x d_second along an axis. Eight products of two numbers below 2^61 sum to less than 2^127.
  Polynomial cross(int first, int second, int axis) const {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    if (bits_ <= 61) return polynomial(small_cross(first, second, x, y));
    return at(first, x) * at(second, y) - at(first, y) * at(second, x);
  }

  /// At most 12 products of three coefficients in each of six terms: of numbers below 2^39, less than 2^124.
  Polynomial determinant() const {
    if (bits_ > 39) return at(0, 0) * cross(1, 2, 0) + at(0, 1) * cross(1, 2, 1) + at(0, 2) * cross(1, 2, 2);
    std::array<Wide, 3 * Degree + 1> sum{};
    for (int axis = 0; axis < 3; ++axis)
      add_product(small_cross(1, 2, (axis + 1) % 3, (axis + 2) % 3), small_[0][axis], 1, sum);
    return polynomial(sum);
  }

 private:
  static constexpr int kAny = 1 << 30;

  std::array<Wide, 2 * Degree + 1> small_cross(int first, int second, int x, int y) const {
    std::array<Wide, 2 * Degree + 1> sum{};
    add_product(small_[first][x], small_[second][y], 1, sum);
    add_product(small_[first][y], small_[second][x], -1, sum);
    return sum;
  }

  void set_axis(const collision::Paths<Degree>& paths, int axis) {
    std::array<std::array<Parts, Degree + 1>, 4> p;
    int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
    for (int vertex = 0; vertex < 4; ++vertex)
      for (int i = 0; i <= Degree; ++i) {
        const double x = paths[vertex][i][axis];
        p[vertex][i] = parts(x);
        if (x == 0.0) continue;
        least = std::min(least, p[vertex][i].exponent);
        most = std::max(most, std::ilogb(x));
      }
    if (least > most) least = most = 0;  // all are zero
    // Six times the largest is below 2^63.
    if (most < least + 59)
      for (int which = 0; which < 3; ++which) {
        small_[which][axis] = relative<std::int64_t>(p[which + 1], p[0], least);
        for (const std::int64_t c : small_[which][axis])
          bits_ = std::max(bits_, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::abs(c)))));
        set(which, axis, small_[which][axis]);
      }
    else
      for (int which = 0; which < 3; ++which) {
        bits_ = kAny;
        set(which, axis, relative<Integer>(p[which + 1], p[0], least));
      }
  }

  template <class Number>
  static std::array<Number, Degree + 1> relative(const std::array<Parts, Degree + 1>& path,
                                                 const std::array<Parts, Degree + 1>& first, int least) {
    const auto number = [&](const Parts& part) {
      return part.mantissa == 0 ? Number(0)
                                : Number(part.mantissa) << static_cast<unsigned>(part.exponent - least);
    };
    constexpr int cubic[4] = {1, 3, 3, 1};
    std::array<Number, Degree + 1> out;
    for (int i = 0; i <= Degree; ++i)
      out[i] = (number(path[i]) - number(first[i])) * (Degree == 3 ? cubic[i] : 1);
    return out;
  }

  template <class Numbers>
  void set(int which, int axis, const Numbers& numbers) {
    d_[which][axis].degree = Degree;
    std::copy(numbers.begin(), numbers.end(), d_[which][axis].c.begin());
  }

  std::array<std::array<Polynomial, 3>, 3> d_;
  std::array<std::array<std::array<std::int64_t, Degree + 1>, 3>, 3> small_{};
  int bits_ = 0;  ///< of the largest of small_, or kAny
};

}  // namespace tendril::exact
