#pragma once

#include <algorithm>
#include <cmath>

#include "dynamics/vector/block.h"
#include "dynamics/vector/pack.h"

/// What elimination does to single blocks, in registers.
namespace tendril {

using Four = lanes::LoosePack;

TENDRIL_INLINE const Four& four(const std::array<double, 4>& a) {
  return *reinterpret_cast<const Four*>(a.data());
}
TENDRIL_INLINE Four& four(std::array<double, 4>& a) {
  return *reinterpret_cast<Four*>(a.data());
}

TENDRIL_INLINE Four& at(double* x) {
  return *reinterpret_cast<Four*>(x);
}

/// to -= a b
template <int B>
TENDRIL_INLINE void subtract_product(const Block<B>& a, const Block<B>& b, Block<B>& to) {
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) {
    Four sum = four(to.column[c]);
    TENDRIL_UNROLL
    for (std::size_t k = 0; k < B; ++k) sum -= four(a.column[k]) * b.column[c][k];
    four(to.column[c]) = sum;
  }
}

/// Four columns by four numbers, as rows and back.
TENDRIL_INLINE void transpose(lanes::Pack (&x)[4]) {
  const lanes::Pack a = __builtin_shufflevector(x[0], x[1], 0, 4, 2, 6);
  const lanes::Pack b = __builtin_shufflevector(x[0], x[1], 1, 5, 3, 7);
  const lanes::Pack c = __builtin_shufflevector(x[2], x[3], 0, 4, 2, 6);
  const lanes::Pack d = __builtin_shufflevector(x[2], x[3], 1, 5, 3, 7);
  x[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  x[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  x[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  x[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// L D U of a block in place, L and U with ones on their diagonals and D inverted, without pivoting: the
/// blocks are close to s^2 times a mass, or stiff and definite. Substitution with these factors, unlike an
/// inverse of the block, keeps what is soft beside what is stiff.
template <int B>
TENDRIL_INLINE bool decompose(Block<B>& block) {
  double a[B][B];  // by rows
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) {
    TENDRIL_UNROLL
    for (std::size_t r = 0; r < B; ++r) a[r][c] = block.column[c][r];
  }
  bool good = true;
  TENDRIL_UNROLL
  for (std::size_t k = 0; k < B; ++k) {
    double largest = 0.0;
    TENDRIL_UNROLL
    for (std::size_t c = k + 1; c < B; ++c) largest = std::max(largest, std::fabs(a[k][c]));
    const double pivot = a[k][k];
    good &= std::fabs(pivot) > 1e-12 * largest && std::fabs(pivot) < 1e300;
    const double inverse = 1.0 / pivot;
    a[k][k] = inverse;
    TENDRIL_UNROLL
    for (std::size_t r = k + 1; r < B; ++r) {
      a[r][k] *= inverse;
      TENDRIL_UNROLL
      for (std::size_t c = k + 1; c < B; ++c) a[r][c] -= a[r][k] * a[k][c];
    }
    TENDRIL_UNROLL
    for (std::size_t c = k + 1; c < B; ++c) a[k][c] *= inverse;
  }
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) {
    TENDRIL_UNROLL
    for (std::size_t r = 0; r < B; ++r) block.column[c][r] = a[r][c];
  }
  return good;
}

/// x = L^-1 x, or (D U)^-1 x, for a column of numbers.
template <int B>
TENDRIL_INLINE void substitute_lower(const Block<B>& factors, double (&x)[B]) {
  TENDRIL_UNROLL
  for (std::size_t k = 0; k + 1 < B; ++k) {
    TENDRIL_UNROLL
    for (std::size_t r = k + 1; r < B; ++r) x[r] -= factors.column[k][r] * x[k];
  }
}
template <int B>
TENDRIL_INLINE void substitute_upper(const Block<B>& factors, double (&x)[B]) {
  TENDRIL_UNROLL
  for (std::size_t k = 0; k < B; ++k) x[k] *= factors.column[k][k];
  TENDRIL_UNROLL
  for (std::size_t k = 1; k < B; ++k) {
    TENDRIL_UNROLL
    for (std::size_t r = 0; r < B - k; ++r) x[r] -= factors.column[B - k][r] * x[B - k];
  }
}

/// a = L^-1 a; and by = (a^T of it) D^-1, where it is asked for
template <int B, bool WithTranspose>
TENDRIL_INLINE void divide_by_lower(const Block<B>& factors, Block<B>& a, Block<B>& by) {
  lanes::Pack row[4] = {};
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) row[c] = four(a.column[c]);
  transpose(row);
  TENDRIL_UNROLL
  for (std::size_t k = 0; k + 1 < B; ++k) {
    TENDRIL_UNROLL
    for (std::size_t r = k + 1; r < B; ++r) row[r] -= factors.column[k][r] * row[k];
  }
  if constexpr (WithTranspose) {
    TENDRIL_UNROLL
    for (std::size_t c = 0; c < B; ++c) four(by.column[c]) = row[c] * factors.column[c][c];
  }
  transpose(row);
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) four(a.column[c]) = row[c];
}

/// a = a (D U)^-1
template <int B>
TENDRIL_INLINE void divide_by_upper(const Block<B>& factors, Block<B>& a) {
  lanes::Pack column[B];
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) {
    column[c] = four(a.column[c]);
    TENDRIL_UNROLL
    for (std::size_t k = 0; k < c; ++k) column[c] -= column[k] * factors.column[c][k];
  }
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) four(a.column[c]) = column[c] * factors.column[c][c];
}

/// y -= a x, the columns in the order in which a substitution gives their numbers
template <int B>
TENDRIL_INLINE void subtract_upwards(const Block<B>& a, const double* x, lanes::Pack& y) {
  TENDRIL_UNROLL
  for (std::size_t c = 0; c < B; ++c) y -= four(a.column[c]) * x[c];
}
template <int B>
TENDRIL_INLINE void subtract_downwards(const Block<B>& a, const double* x, lanes::Pack& y) {
  TENDRIL_UNROLL
  for (std::size_t c = 1; c <= B; ++c) y -= four(a.column[B - c]) * x[B - c];
}

}  // namespace tendril
