#include "polynomial.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tendril::exact {
namespace {

/// From the c_i of sum c_i x^i (x + y)^(n - i) those of sum c_i x^i y^(n - i).
void shift(Polynomial& p) {
  for (int last = p.degree; last > 0; --last)
    for (int i = 1; i <= last; ++i) p.c[i] += p.c[i - 1];
}

void reverse(Polynomial& p) {
  std::reverse(p.c.begin(), p.c.begin() + p.degree + 1);
}

constexpr int binomials[10][10] = {{1},
                                   {1, 1},
                                   {1, 2, 1},
                                   {1, 3, 3, 1},
                                   {1, 4, 6, 4, 1},
                                   {1, 5, 10, 10, 5, 1},
                                   {1, 6, 15, 20, 15, 6, 1},
                                   {1, 7, 21, 35, 35, 21, 7, 1},
                                   {1, 8, 28, 56, 70, 56, 28, 8, 1},
                                   {1, 9, 36, 84, 126, 126, 84, 36, 9, 1}};

/// The largest prime below 2^61: sums and products fit the double width.
constexpr std::uint64_t prime = (std::uint64_t{1} << 61) - 1;
using Residues = std::vector<std::uint64_t>;

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  __extension__ using Unsigned = unsigned __int128;
  return static_cast<std::uint64_t>(static_cast<Unsigned>(a) * b % prime);
}

std::uint64_t inverse(std::uint64_t a) {
  std::uint64_t result = 1;
  for (std::uint64_t power = prime - 2; power != 0; power >>= 1, a = times(a, a))
    if (power & 1) result = times(result, a);
  return result;
}

void trim(Residues& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}

Residues residues(const Polynomial& p) {
  Residues r;
  for (int i = 0; i <= p.degree; ++i) {
    const auto rest = static_cast<std::uint64_t>(abs(p.c[i]) % prime);
    r.push_back(p.c[i] < 0 && rest != 0 ? prime - rest : rest);
  }
  trim(r);
  return r;
}

/// a modulo b
void reduce(Residues& a, const Residues& b) {
  const std::uint64_t lead = inverse(b.back());
  while (a.size() >= b.size()) {
    const std::uint64_t factor = times(a.back(), lead);
    const std::size_t offset = a.size() - b.size();
    for (std::size_t i = 0; i < b.size(); ++i)
      a[offset + i] = (a[offset + i] + prime - times(factor, b[i])) % prime;
    trim(a);
  }
}

void trim(Polynomial& p) {
  while (p.degree > 0 && p.c[p.degree] == 0) --p.degree;
}

/// Divides by the greatest common divisor of the coefficients.
void make_primitive(Polynomial& p) {
  Integer content = 0;
  for (int i = 0; i <= p.degree; ++i) content = gcd(content, p.c[i]);
  if (content > 1)
    for (int i = 0; i <= p.degree; ++i) p.c[i] /= content;
}

/// One step of the division of a by b in x, multiplied through: a becomes of lower degree. The factor of
/// x^offset.
Integer cancel_lead(Polynomial& a, const Polynomial& b) {
  const int offset = a.degree - b.degree;
  const Integer lead = a.c[a.degree];
  for (int i = 0; i < a.degree; ++i) a.c[i] *= b.c[b.degree];
  for (int i = 0; i < b.degree; ++i) a.c[offset + i] -= lead * b.c[i];
  a.c[a.degree] = 0;
  --a.degree;
  return lead;
}

}  // namespace

bool is_zero(const Polynomial& p) {
  return std::all_of(p.c.begin(), p.c.begin() + p.degree + 1, [](const Integer& c) { return c == 0; });
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
  Polynomial sum{p.degree, {}};
  for (int i = 0; i <= p.degree; ++i) sum.c[i] = p.c[i] + q.c[i];
  return sum;
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) {
  Polynomial difference{p.degree, {}};
  for (int i = 0; i <= p.degree; ++i) difference.c[i] = p.c[i] - q.c[i];
  return difference;
}

Polynomial operator-(const Polynomial& p) {
  Polynomial negative{p.degree, {}};
  for (int i = 0; i <= p.degree; ++i) negative.c[i] = -p.c[i];
  return negative;
}

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  Polynomial product{p.degree + q.degree, {}};
  for (int i = 0; i <= p.degree; ++i)
    for (int j = 0; j <= q.degree; ++j) product.c[i + j] += p.c[i] * q.c[j];
  return product;
}

bool proportional(const Polynomial& p, const Polynomial& q) {
  if (p.degree != q.degree) return false;
  int k = 0;
  while (k < p.degree && p.c[k] == 0) ++k;
  const bool same = p.c[k] == q.c[k];
  for (int i = 0; i <= p.degree; ++i)
    if (same ? p.c[i] != q.c[i] : (p.c[i] == 0) != (q.c[i] == 0) || p.c[i] * q.c[k] != q.c[i] * p.c[k])
      return false;
  return true;
}

int sign_at(const Polynomial& p, const Dyadic& t) {
  if (t.exponent == 0) return (t.numerator == 0 ? p.c[0] : p.c[p.degree]).sign();
  const Integer rest = (Integer(1) << t.exponent) - t.numerator;
  Integer value = p.c[p.degree];
  Integer power = 1;
  for (int i = p.degree - 1; i >= 0; --i) {
    power *= rest;
    value *= t.numerator;
    value += p.c[i] * power;
  }
  return value.sign();
}

/// With t = l + (r - l) s and the common denominator 2^e: t is l (1 - s) + r s and 1 - t is (2^e - l) (1 - s)
/// + (2^e - r) s, times 2^-e, so Horner's rule over products of linear forms gives the coefficients.
Polynomial restricted(const Polynomial& p, const Dyadic& low, const Dyadic& high) {
  const unsigned e = std::max(low.exponent, high.exponent);
  const Integer l = low.numerator << (e - low.exponent);
  const Integer r = high.numerator << (e - high.exponent);
  const Integer one = Integer(1) << e;
  Polynomial t{1, {}};
  t.c[0] = l;
  t.c[1] = r;
  Polynomial rest{1, {}};
  rest.c[0] = one - l;
  rest.c[1] = one - r;
  Polynomial value{0, {}};
  value.c[0] = p.c[p.degree];
  Polynomial power{0, {}};
  power.c[0] = 1;
  for (int i = p.degree - 1; i >= 0; --i) {
    power = power * rest;
    value = value * t;
    for (int j = 0; j <= power.degree; ++j) value.c[j] += p.c[i] * power.c[j];
  }
  return value;
}

Polynomial first_half(const Polynomial& p) {
  Polynomial half = p;
  shift(half);
  for (int i = 0; i < p.degree; ++i) half.c[i] <<= static_cast<unsigned>(p.degree - i);
  return half;
}

Polynomial second_half(const Polynomial& p) {
  Polynomial half = p;
  reverse(half);
  half = first_half(half);
  reverse(half);
  return half;
}

int sign_changes(const Polynomial& p) {
  int changes = 0;
  int last = 0;
  for (int i = 0; i <= p.degree; ++i) {
    const int sign = p.c[i].sign();
    if (sign * last < 0) ++changes;
    if (sign != 0) last = sign;
  }
  return changes;
}

int first_sign(const Polynomial& p) {
  for (int i = 0; i <= p.degree; ++i)
    if (p.c[i] != 0) return p.c[i].sign();
  return 0;
}

int last_sign(const Polynomial& p) {
  for (int i = p.degree; i >= 0; --i)
    if (p.c[i] != 0) return p.c[i].sign();
  return 0;
}

std::array<double, 10> in_doubles(const Polynomial& p) {
  unsigned bits = 0;
  for (int i = 0; i <= p.degree; ++i)
    if (p.c[i] != 0) bits = std::max(bits, static_cast<unsigned>(msb(abs(p.c[i]))) + 1);
  const unsigned drop = bits > 60 ? bits - 60 : 0;
  std::array<double, 10> c{};
  for (int i = 0; i <= p.degree; ++i) {
    const auto kept = static_cast<double>(static_cast<std::int64_t>(abs(p.c[i]) >> drop));
    c[i] = (p.c[i] < 0 ? -kept : kept) / binomials[p.degree][i];
  }
  return c;
}

Polynomial without_ends(const Polynomial& p) {
  int low = 0;
  while (low < p.degree && p.c[low] == 0) ++low;
  int high = p.degree;
  while (high > low && p.c[high] == 0) --high;
  Polynomial inner{high - low, {}};
  std::copy(p.c.begin() + low, p.c.begin() + high + 1, inner.c.begin());
  return inner;
}

Polynomial common_divisor(const Polynomial& p, const Polynomial& q) {
  Polynomial a = p;
  Polynomial b = q;
  make_primitive(a);
  make_primitive(b);
  if (a.degree < b.degree) std::swap(a, b);
  while (!is_zero(b)) {
    while (a.degree >= b.degree && !is_zero(a)) {
      cancel_lead(a, b);
      trim(a);
      if (b.degree == 0) break;
    }
    if (b.degree == 0) return b;
    make_primitive(a);
    std::swap(a, b);
  }
  return a;
}

bool surely_coprime(const Polynomial& p, const Polynomial& q) {
  Residues a = residues(p);
  Residues b = residues(q);
  if (a.size() != static_cast<std::size_t>(p.degree) + 1 || b.empty()) return false;
  while (!b.empty()) {
    reduce(a, b);
    std::swap(a, b);
  }
  return a.size() == 1;
}

Polynomial derivative(const Polynomial& p) {
  Polynomial slope{std::max(p.degree - 1, 0), {}};
  for (int i = 1; i <= p.degree; ++i) slope.c[i - 1] = i * p.c[i];
  return slope;
}

Polynomial quotient(const Polynomial& p, const Polynomial& q) {
  Polynomial rest = p;
  Polynomial result{p.degree - q.degree, {}};
  for (int offset = result.degree; offset >= 0; --offset) {
    for (int i = offset + 1; i <= result.degree; ++i) result.c[i] *= q.c[q.degree];
    result.c[offset] = cancel_lead(rest, q);
  }
  make_primitive(result);
  return result;
}

}  // namespace tendril::exact
