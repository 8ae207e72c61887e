#include <tendril/collision/box_queries.h>

#include <cmath>

namespace tendril::collision {

double square_distance(const Box& box, const Vec3& point) {
  return (box.low - point).cwiseMax(point - box.high).cwiseMax(0.0).squaredNorm();
}

/// By the separating axes of a box and a segment: the box's own, and those across the segment. Twice the
/// middles and half sizes are compared, so that nothing is rounded but sums and products.
bool segment_meets(const Box& box, const Vec3& a, const Vec3& b) {
  if (!(box.high - box.low).allFinite()) return true;
  const Vec3 size = box.high - box.low, along = b - a, apart = (a + b) - (box.low + box.high);
  const double slack =
      0x1p-48 * (size.cwiseAbs().maxCoeff() + a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff() +
                 box.low.cwiseAbs().maxCoeff() + box.high.cwiseAbs().maxCoeff());
  const Vec3 half = along.cwiseAbs();
  if ((apart.cwiseAbs().array() > (size + half).array() + slack).any()) return false;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double reach = size[j] * half[k] + size[k] * half[j];
    if (std::abs(apart[j] * along[k] - apart[k] * along[j]) >
        reach + 2.0 * slack * (half[j] + half[k] + slack))
      return false;
  }
  return true;
}

}  // namespace tendril::collision
