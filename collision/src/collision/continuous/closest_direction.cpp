#include "closest_direction.h"

#include <algorithm>

namespace tendril::collision {
namespace {

/// The point of the segment from a, by `along`, closest to the origin.
Vec3 closest_on_segment(const Vec3& a, const Vec3& along) {
  const double square = along.squaredNorm();
  const double s = square > 0.0 ? std::clamp(-a.dot(along) / square, 0.0, 1.0) : 0.0;
  return a + s * along;
}

const Vec3& shorter(const Vec3& a, const Vec3& b) {
  return a.squaredNorm() < b.squaredNorm() ? a : b;
}

}  // namespace

Vec3 vertex_face_direction(const Instant& at) {
  const Vec3 a = vector(at.place, 0);
  const Vec3 b = vector(at.place, 1);
  const Vec3 c = vector(at.place, 2);
  const Vec3 ab = b - a;
  const Vec3 bc = c - b;
  const Vec3 ca = a - c;
  const Vec3 normal = ab.cross(bc);
  // Beyond an edge line the closest point is on the edges that show the vertex their outside.
  const bool beyond_ab = normal.cross(ab).dot(a) > 0.0;
  const bool beyond_bc = normal.cross(bc).dot(b) > 0.0;
  const bool beyond_ca = normal.cross(ca).dot(c) > 0.0;
  if (!beyond_ab && !beyond_bc && !beyond_ca) return normal.dot(a) < 0.0 ? Vec3(-normal) : normal;
  Vec3 best = beyond_ab ? closest_on_segment(a, ab)
                        : (beyond_bc ? closest_on_segment(b, bc) : closest_on_segment(c, ca));
  if (beyond_ab && beyond_bc) best = shorter(best, closest_on_segment(b, bc));
  if (beyond_ca && (beyond_ab || beyond_bc)) best = shorter(best, closest_on_segment(c, ca));
  return best;
}

Vec3 edge_edge_direction(const Instant& at) {
  const Vec3 a = vector(at.place, 0);
  const Vec3 b = vector(at.place, 1);
  const Vec3 along = Vec3(vector(at.place, 2)) - b;
  const double aa = a.squaredNorm();
  const double ee = along.squaredNorm();
  const double ae = a.dot(along);
  const double ab = a.dot(b);
  const double eb = along.dot(b);
  const double area = aa * ee - ae * ae;
  double s = area > 0.0 ? std::clamp((ab * ee - ae * eb) / area, 0.0, 1.0) : 0.0;
  double r = ee > 0.0 ? std::clamp((s * ae - eb) / ee, 0.0, 1.0) : 0.0;
  if (aa > 0.0) s = std::clamp((ab + r * ae) / aa, 0.0, 1.0);
  Vec3 between = b + r * along - s * a;
  // Of edges that cross, seen along their common normal, that normal is the better direction.
  if (s > 0.0 && s < 1.0 && r > 0.0 && r < 1.0) {
    const Vec3 normal = a.cross(along);
    between = normal.dot(b) < 0.0 ? Vec3(-normal) : normal;
  }
  return between;
}

}  // namespace tendril::collision
