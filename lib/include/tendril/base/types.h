#pragma once

#include <tendril/base/export.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

/// Vectors and spans shared by every module.
///
/// World frame: right-handed, fixed. Units are the caller's own, used consistently: a length, a mass and a
/// time unit; everything else follows from them. Angles are radians.
namespace tendril {

/// A point or a vector of the world frame.
using Vec3 = Eigen::Vector3d;
/// A linear map of such vectors.
using Mat3 = Eigen::Matrix3d;

/// Contiguous view on points or vectors, one entry per node, vertex or control point.
using Points = std::span<const Vec3>;
/// The same, to be written to.
using MutablePoints = std::span<Vec3>;

/// True when every coordinate is finite. NaN kills the process inside some geometry kernels, so input is
/// checked once, where it enters.
inline bool is_finite(const Vec3& v) {
  return v.allFinite();
}
/// The same of every point; true of none.
TENDRIL_CORE_API bool all_finite(Points points);

}  // namespace tendril
