#pragma once

#include <array>
#include <cstddef>

#include "columns.h"
#include "lanes.h"

/// What loops over neighbours compute with whose bodies are too long for a compiler to vectorise: they are
/// written for a type T that is a number (double) or a pack, one of each of four neighbours in a row.
namespace tendril::lanes {

/// Four numbers in a register.
typedef double Pack __attribute__((vector_size(32)));
/// The same wherever they lie.
typedef double LoosePack __attribute__((vector_size(32), aligned(8), may_alias));

template <class T>
constexpr std::size_t kLanes = sizeof(T) / sizeof(double);

template <class T>
TENDRIL_INLINE T load(const double* from) {
  if constexpr (kLanes<T> == 1)
    return *from;
  else
    return *reinterpret_cast<const LoosePack*>(from);
}
template <class T>
TENDRIL_INLINE void store(const T& a, double* to) {
  if constexpr (kLanes<T> == 1)
    *to = a;
  else
    *reinterpret_cast<LoosePack*>(to) = a;
}
/// Every other number.
template <class T>
TENDRIL_INLINE T load_apart(const double* from) {
  if constexpr (kLanes<T> == 1)
    return *from;
  else
    return T{from[0], from[2], from[4], from[6]};
}
template <class T>
TENDRIL_INLINE Triple<T> load(const Columns3& from, std::size_t i) {
  return {load<T>(from.x.data() + i), load<T>(from.y.data() + i), load<T>(from.z.data() + i)};
}

/// Number k of a pack.
TENDRIL_INLINE double lane(double a, std::size_t) {
  return a;
}
TENDRIL_INLINE double lane(const Pack& a, std::size_t k) {
  return a[k];
}
TENDRIL_INLINE void set_lane(double& a, std::size_t, double value) {
  a = value;
}
TENDRIL_INLINE void set_lane(Pack& a, std::size_t k, double value) {
  a[k] = value;
}

/// A matrix by its columns.
template <class T>
struct Matrix {
  Triple<T> c[3];
};

template <class T>
TENDRIL_INLINE Matrix<T> operator+(const Matrix<T>& a, const Matrix<T>& b) {
  return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}};
}
template <class T>
TENDRIL_INLINE Matrix<T> operator-(const Matrix<T>& a, const Matrix<T>& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}
template <class T>
TENDRIL_INLINE Matrix<T> operator*(std::type_identity_t<T> s, const Matrix<T>& a) {
  return {{s * a.c[0], s * a.c[1], s * a.c[2]}};
}
template <class T>
TENDRIL_INLINE Matrix<T> transposed(const Matrix<T>& a) {
  return {{{a.c[0].x, a.c[1].x, a.c[2].x}, {a.c[0].y, a.c[1].y, a.c[2].y}, {a.c[0].z, a.c[1].z, a.c[2].z}}};
}
/// a b^T
template <class T>
TENDRIL_INLINE Matrix<T> outer(const Triple<T>& a, const Triple<T>& b) {
  return {{b.x * a, b.y * a, b.z * a}};
}
/// a b^T + b a^T
template <class T>
TENDRIL_INLINE Matrix<T> outer_both(const Triple<T>& a, const Triple<T>& b) {
  return outer(a, b) + outer(b, a);
}
template <class T>
TENDRIL_INLINE Matrix<T> diagonal(const T& a) {
  const T zero{};
  return {{{a, zero, zero}, {zero, a, zero}, {zero, zero, a}}};
}
template <class T>
TENDRIL_INLINE Matrix<T> cross_matrix(const Triple<T>& v) {
  const T zero{};
  return {{{zero, v.z, -v.y}, {-v.z, zero, v.x}, {v.y, -v.x, zero}}};
}

/// a - (n.a) n
template <class T>
TENDRIL_INLINE Triple<T> across(const Triple<T>& n, const Triple<T>& a) {
  return a - dot(n, a) * n;
}
/// (1 - n n^T) a
template <class T>
TENDRIL_INLINE Matrix<T> project_left(const Triple<T>& n, const Matrix<T>& a) {
  return {{across(n, a.c[0]), across(n, a.c[1]), across(n, a.c[2])}};
}
/// a (1 - n n^T)
template <class T>
TENDRIL_INLINE Matrix<T> project_right(const Matrix<T>& a, const Triple<T>& n) {
  return a - outer(n.x * a.c[0] + n.y * a.c[1] + n.z * a.c[2], n);
}

/// Second derivative of g.n by d, n = d / |d|.
template <class T>
TENDRIL_INLINE Matrix<T> curvature_of_unit(const Triple<T>& n, const T& inverse_length, const Triple<T>& g) {
  const T along = dot(g, n);
  const T square = inverse_length * inverse_length;
  const Triple<T> u = square * (1.5 * along * n - g);
  return outer_both(u, n) - diagonal<T>(square * along);
}

/// A column of the blocks of a pack's members, (x, y, z, w): member k's goes to `to` + k `stride`.
TENDRIL_INLINE void put_columns(const Triple<double>& a, double w, double* to, std::size_t) {
  to[0] = a.x;
  to[1] = a.y;
  to[2] = a.z;
  to[3] = w;
}
TENDRIL_INLINE void put_columns(const Triple<Pack>& a, const Pack& w, double* to, std::size_t stride) {
  const Pack xy02 = __builtin_shufflevector(a.x, a.y, 0, 4, 2, 6);
  const Pack xy13 = __builtin_shufflevector(a.x, a.y, 1, 5, 3, 7);
  const Pack zw02 = __builtin_shufflevector(a.z, w, 0, 4, 2, 6);
  const Pack zw13 = __builtin_shufflevector(a.z, w, 1, 5, 3, 7);
  const auto put = [&](std::size_t k, const Pack& column) __attribute__((always_inline)) {
    *reinterpret_cast<LoosePack*>(to + k * stride) = column;
  };
  put(0, __builtin_shufflevector(xy02, zw02, 0, 1, 4, 5));
  put(1, __builtin_shufflevector(xy13, zw13, 0, 1, 4, 5));
  put(2, __builtin_shufflevector(xy02, zw02, 2, 3, 6, 7));
  put(3, __builtin_shufflevector(xy13, zw13, 2, 3, 6, 7));
}

}  // namespace tendril::lanes
