#include <ccd/ccd.h>

#include "accuracy/collision/adapter.h"

/// libccd: GJK of convex hulls.
namespace tendril::suite {
namespace {

void support(const void* object, const ccd_vec3_t* way, ccd_vec3_t* out) {
  const auto& hull = *static_cast<const std::span<const Vec3>*>(object);
  const Vec3 d(way->v[0], way->v[1], way->v[2]);
  const Vec3* best = &hull[0];
  for (const Vec3& x : hull)
    if (d.dot(x) > d.dot(*best)) best = &x;
  ccdVec3Set(out, best->x(), best->y(), best->z());
}

void centre(const void* object, ccd_vec3_t* out) {
  const auto& hull = *static_cast<const std::span<const Vec3>*>(object);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : hull) sum += x;
  sum /= static_cast<double>(hull.size());
  ccdVec3Set(out, sum.x(), sum.y(), sum.z());
}

Said meet(std::span<const Vec3> a, std::span<const Vec3> b) {
  ccd_t options;
  CCD_INIT(&options);
  options.support1 = options.support2 = support;
  options.center1 = options.center2 = centre;
  options.max_iterations = 200;
  return ccdGJKIntersect(&a, &b, &options) != 0;
}

}  // namespace

Adapter ccd_adapter() {
  Adapter out{"libccd, GJK"};
  out.proper = true;
  out.triangles = [](const Corners& a, const Corners& b) { return meet(a, b); };
  out.segment = [](const Corners& a, const Ends& s) { return meet(a, s); };
  return out;
}

}  // namespace tendril::suite
