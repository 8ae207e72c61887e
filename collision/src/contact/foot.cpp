#include "foot.h"

#include <algorithm>

namespace tendril::contact {
namespace {

constexpr double kParallel = 1e-12;  // of the square of the sine: below, a line is tried at its ends

double on_segment(const Vec3& x, const Vec3& from, const Vec3& along) {
  const double square = along.squaredNorm();
  return square > 0.0 ? std::clamp((x - from).dot(along) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

Foot foot_on(const std::array<Vec3, 3>& t, const Vec3& x) {
  using Part = Foot::Part;
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], a = x - t[0], b = x - t[1], c = x - t[2];
  const double d1 = ab.dot(a), d2 = ac.dot(a), d3 = ab.dot(b), d4 = ac.dot(b), d5 = ab.dot(c), d6 = ac.dot(c);
  if (d1 <= 0.0 && d2 <= 0.0) return {t[0], Part::corner, 0, {1.0, 0.0, 0.0}};
  if (d3 >= 0.0 && d4 <= d3) return {t[1], Part::corner, 1, {0.0, 1.0, 0.0}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double y = d1 / (d1 - d3);
    return {t[0] + y * ab, Part::edge, 0, {1.0 - y, y, 0.0}};
  }
  if (d6 >= 0.0 && d5 <= d6) return {t[2], Part::corner, 2, {0.0, 0.0, 1.0}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double y = d2 / (d2 - d6);
    return {t[0] + y * ac, Part::edge, 2, {1.0 - y, 0.0, y}};
  }
  const double va = d3 * d6 - d5 * d4, on_bc = d4 - d3, off_bc = d5 - d6;
  if (va <= 0.0 && on_bc >= 0.0 && off_bc >= 0.0) {
    const double y = on_bc / (on_bc + off_bc);
    return {t[1] + y * (t[2] - t[1]), Part::edge, 1, {0.0, 1.0 - y, y}};
  }
  const double sum = va + vb + vc, y = vb / sum, z = vc / sum;
  return {t[0] + y * ab + z * ac, Part::face, 0, {1.0 - y - z, y, z}};
}

/// The least of a convex function on a square: within, or on a side, where the other end is the nearest point
/// of its segment [Ericson 2005] 5.1.9.
SegmentFeet feet_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), det = uu * vv - uv * uv;
  double s = 0.0;
  if (det > kParallel * uu * vv) s = std::clamp((uv * v.dot(w) - vv * u.dot(w)) / det, 0.0, 1.0);
  const double free = vv > 0.0 ? v.dot(w + s * u) / vv : 0.0, t = std::clamp(free, 0.0, 1.0);
  if (t != free || !(vv > 0.0)) s = on_segment(c + t * v, a, u);
  return {s, t};
}

}  // namespace tendril::contact
