#include "group_lanes.h"

#include <cmath>

namespace tendril::search {

TENDRIL_LANES void measure(GroupLanes& group, const Segment& segment, double number, double* square) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const V3 q = V3{group.x[i], group.y[i], group.z[i]} - segment.start;
    const double s = dot(q, segment.axis) * segment.inverse_length2;
    const V3 off = q - smaller(larger(s, 0.0), 1.0) * segment.axis;
    const double d = dot(off, off);
    square[i] = d;
    const bool nearer = d < group.square[i];
    group.square[i] = nearer ? d : group.square[i];
    group.radius[i] = nearer ? segment.radius : group.radius[i];
    group.nearest[i] = nearer ? number : group.nearest[i];
  }
}

TENDRIL_LANES void mark(const GroupLanes& group, double radius, const double* square, unsigned char* near) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double reach = group.cut[i] + radius;
    near[i] = square[i] <= reach * reach;
  }
}

TENDRIL_LANES void measure(const double* x, const double* y, const double* z, std::size_t count, const V3& c,
                           double* distance) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) distance[i] = norm(V3{x[i], y[i], z[i]} - c);
}

TENDRIL_LANES void bisect(const double* x, const double* y, const double* z, const double* radius,
                          const double* distance, std::size_t count, const Reference& to,
                          unsigned char* beyond) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const V3 apart = V3{x[i], y[i], z[i]} - to.centre;
    const double turn =
        to.half.x * std::fabs(apart.x) + to.half.y * std::fabs(apart.y) + to.half.z * std::fabs(apart.z);
    const double sum = distance[i] + to.distance;
    const double least = (distance[i] - to.distance) * sum - 2.0 * turn;
    beyond[i] = least > (radius[i] + to.margin) * (sum + to.across);
  }
}

}  // namespace tendril::search
