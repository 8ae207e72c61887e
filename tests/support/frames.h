#pragma once

#include <tendril/curve/frames.h>

#include <cmath>

namespace tendril::test {

/// How far a frame is from orthonormal and right-handed.
inline double departure(const Frame& f) {
  Mat3 m;
  m << f.x, f.y, f.z;
  return (m.transpose() * m - Mat3::Identity()).norm() + std::abs(f.x.cross(f.y).dot(f.z) - 1.0);
}

}  // namespace tendril::test
