#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/curve_pair.h>

namespace tendril {

/// A point in the axial space of a curve-pair ([Chan 2008] section 2.2): s = c(t) + u l_x(t) + v l_y(t) +
/// w l_z(t), lengths in the unit of the curve. At a normal projection w is 0 up to rounding; it is not 0 for
/// points beyond the two ends, at a kink and at a point of zero speed, and is kept everywhere so that the
/// rest shape is reproduced for any t.
struct AxialPoint {
  double t = 0.0;  ///< parameter, in the curve's domain
  double u = 0.0;  ///< along l_x [length]
  double v = 0.0;  ///< along l_y, towards the orientation curve [length]
  double w = 0.0;  ///< along the tangent l_z [length]
};

/// The coordinates of `point` at the parameter t (clamped to the domain), by dot products with the frame at
/// t. Exact inverse of from_axial on the same curve-pair up to rounding, whatever the frame's status.
TENDRIL_CORE_API AxialPoint to_axial(const CurvePair& pair, double t, const Vec3& point);

/// The point with these coordinates on a curve-pair, usually one that has moved since.
TENDRIL_CORE_API Vec3 from_axial(const CurvePair& pair, const AxialPoint& record);

}  // namespace tendril
