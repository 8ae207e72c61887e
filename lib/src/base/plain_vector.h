#pragma once

#include <cmath>

#include "vector_loops.h"

/// What vector loops compute with in place of Eigen's vectors, which would keep them from being vectorised.
namespace tendril::lanes {

/// Three numbers in registers.
struct V3 {
  double x, y, z;
};

TENDRIL_INLINE V3 operator+(const V3& a, const V3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
TENDRIL_INLINE V3 operator-(const V3& a, const V3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
TENDRIL_INLINE V3 operator*(double s, const V3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
TENDRIL_INLINE double dot(const V3& a, const V3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
TENDRIL_INLINE double norm(const V3& a) {
  return std::sqrt(dot(a, a));
}
TENDRIL_INLINE V3 cross(const V3& a, const V3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
TENDRIL_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
TENDRIL_INLINE double smaller(double a, double b) {
  return a < b ? a : b;
}

}  // namespace tendril::lanes
