#include "fraction.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tendril::collision {
namespace {

/// 2^1074, the largest denominator of a double, has 324.
constexpr std::size_t most_digits = 1000;

/// A natural number, 32 bits an entry, the least first; no entry of it is a leading zero.
using Natural = std::vector<std::uint32_t>;

void multiply_add(Natural& n, std::uint32_t factor, std::uint32_t summand) {
  std::uint64_t carry = summand;
  for (std::uint32_t& word : n) {
    carry += std::uint64_t{word} * factor;
    word = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  if (carry != 0) n.push_back(static_cast<std::uint32_t>(carry));
}

/// n / divisor in place.
/// \return  the remainder
std::uint32_t divide(Natural& n, std::uint32_t divisor) {
  std::uint64_t rest = 0;
  for (auto word = n.rbegin(); word != n.rend(); ++word) {
    rest = (rest << 32) | *word;
    *word = static_cast<std::uint32_t>(rest / divisor);
    rest %= divisor;
  }
  while (!n.empty() && n.back() == 0) n.pop_back();
  return static_cast<std::uint32_t>(rest);
}

std::optional<Natural> from_digits(std::string_view digits) {
  if (digits.empty() || digits.size() > most_digits) return {};
  Natural n;
  for (const char digit : digits) {
    if (digit < '0' || digit > '9') return {};
    multiply_add(n, 10, static_cast<std::uint32_t>(digit - '0'));
  }
  return n;
}

std::string to_digits(Natural n) {
  std::string digits;
  do digits.push_back(static_cast<char>('0' + divide(n, 10)));
  while (!n.empty());
  std::reverse(digits.begin(), digits.end());
  return digits;
}

int trailing_zeros(const Natural& n) {
  int zeros = 0;
  for (const std::uint32_t word : n) {
    if (word != 0) return zeros + std::countr_zero(word);
    zeros += 32;
  }
  return zeros;
}

int bits(const Natural& n) {
  return n.empty() ? 0 : static_cast<int>(32 * n.size()) - std::countl_zero(n.back());
}

/// n / 2^shift of a number of at most 53 bits above the shift.
double scaled(const Natural& n, int shift) {
  double value = 0.0;
  for (std::size_t i = 0; i < n.size(); ++i) value += std::ldexp(n[i], static_cast<int>(32 * i) - shift);
  return value;
}

Natural power_of_two(int exponent) {
  Natural n(static_cast<std::size_t>(exponent / 32) + 1, 0);
  n.back() = std::uint32_t{1} << (exponent % 32);
  return n;
}

}  // namespace

std::optional<double> from_fraction(std::string_view numerator, std::string_view denominator) {
  const bool negative = numerator.starts_with('-');
  const auto n = from_digits(numerator.substr(negative ? 1 : 0));
  const auto d = from_digits(denominator);
  if (!n || !d || d->empty()) return {};
  if (n->empty()) return 0.0;
  const int zeros = trailing_zeros(*n);
  const int halvings = trailing_zeros(*d);
  if (bits(*n) - zeros > 53 || bits(*d) - halvings != 1) return {};
  const double mantissa = scaled(*n, zeros);
  const double value = std::ldexp(mantissa, zeros - halvings);
  if (!std::isfinite(value) || std::ldexp(value, halvings - zeros) != mantissa) return {};
  return negative ? -value : value;
}

std::string to_fraction(double x) {
  if (x == 0.0) return "0,1";
  int exponent = 0;
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
  exponent -= 53;
  const int zeros = std::countr_zero(mantissa);
  mantissa >>= zeros;
  exponent += zeros;
  Natural n{static_cast<std::uint32_t>(mantissa), static_cast<std::uint32_t>(mantissa >> 32)};
  if (n.back() == 0) n.pop_back();
  for (int i = 0; i < exponent; ++i) multiply_add(n, 2, 0);
  return (x < 0.0 ? "-" : "") + to_digits(n) + ',' + to_digits(power_of_two(std::max(0, -exponent)));
}

}  // namespace tendril::collision
