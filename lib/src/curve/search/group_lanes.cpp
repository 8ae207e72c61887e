#include "group_lanes.h"

#include <cmath>

namespace tendril::search {

// The point of the segment a + s d, 0 <= s <= 1, nearest to p is at s = (p - a) . d / d^2, taken to the ends
// of the interval. Where the piece's ends meet, 1 / d^2 is stored as 0, and s is 0.
TENDRIL_LANES void measure_piece(GroupLanes& group, const NearPiece& piece, double number, double* square) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const V3 q = V3{group.x[i], group.y[i], group.z[i]} - piece.start;
    const double s = dot(q, piece.axis) * piece.inverse_length2;
    const V3 off = q - smaller(larger(s, 0.0), 1.0) * piece.axis;
    const double d = dot(off, off);
    square[i] = d;
    const bool nearer = d < group.square[i];
    group.square[i] = nearer ? d : group.square[i];
    group.radius[i] = nearer ? piece.radius : group.radius[i];
    group.nearest[i] = nearer ? number : group.nearest[i];
  }
}

TENDRIL_LANES void mark_near(const GroupLanes& group, double radius, const double* square,
                             unsigned char* near) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double reach = group.cut[i] + radius;
    near[i] = square[i] <= reach * reach;
  }
}

TENDRIL_LANES void measure_balls(Balls& balls, const V3& c) {
  const std::size_t count = balls.size();
  balls.distance.resize(count);
  const double* __restrict x = balls.x.data();
  const double* __restrict y = balls.y.data();
  const double* __restrict z = balls.z.data();
  double* __restrict distance = balls.distance.data();
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) distance[i] = norm(V3{x[i], y[i], z[i]} - c);
}

TENDRIL_LANES void mark_beyond(Balls& balls, const Reference& to) {
  const std::size_t count = balls.size();
  balls.beyond.resize(count);
  const double *__restrict x = balls.x.data(), *__restrict y = balls.y.data(), *__restrict z = balls.z.data(),
               *__restrict radius = balls.radius.data(), *__restrict distance = balls.distance.data();
  unsigned char* __restrict beyond = balls.beyond.data();
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
