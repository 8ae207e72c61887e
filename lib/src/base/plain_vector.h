#pragma once

#include <cmath>
#include <type_traits>

#include "vector_loops.h"

/// What vector loops compute with in place of Eigen's vectors, which would keep them from being vectorised.
namespace tendril::lanes {

/// Three numbers in registers.
template <class T>
struct Triple {
  T x, y, z;
};
using V3 = Triple<double>;

template <class T>
TENDRIL_INLINE Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
TENDRIL_INLINE Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
TENDRIL_INLINE Triple<T> operator*(std::type_identity_t<T> s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
TENDRIL_INLINE T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TENDRIL_INLINE double norm(const V3& a) {
  return std::sqrt(dot(a, a));
}
template <class T>
TENDRIL_INLINE Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TENDRIL_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
TENDRIL_INLINE double smaller(double a, double b) {
  return a < b ? a : b;
}

}  // namespace tendril::lanes
