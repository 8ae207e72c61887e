#include <tendril/curve/axial.h>

namespace tendril {

AxialPoint to_axial(const CurvePair& pair, double t, const Vec3& point) {
  const CurveFrame at = pair.frame(t);
  const Vec3 a = point - at.origin;
  return {t, a.dot(at.frame.x), a.dot(at.frame.y), a.dot(at.frame.z)};
}

Vec3 from_axial(const CurvePair& pair, const AxialPoint& record) {
  const CurveFrame at = pair.frame(record.t);
  return at.origin + record.u * at.frame.x + record.v * at.frame.y + record.w * at.frame.z;
}

}  // namespace tendril
