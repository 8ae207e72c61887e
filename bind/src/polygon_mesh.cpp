#include <tendril/bind/polygon_mesh.h>

namespace tendril::bind {

double bounding_diagonal(Points points) {
  if (points.empty()) return 0.0;
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace tendril::bind
