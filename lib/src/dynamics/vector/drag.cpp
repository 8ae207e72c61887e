#include "drag.h"

#include "lanes.h"

namespace tendril {
namespace {

TENDRIL_LANES void drag_of(const DragPerLength& by, std::size_t count, ExposedEdges& edges) {
  double* __restrict x = edges.x.data(), * __restrict y = edges.y.data(), * __restrict z = edges.z.data();
  const double* __restrict vx = edges.vx.data(), * __restrict vy = edges.vy.data(), * __restrict vz = edges.vz.data();
  const double* __restrict width = edges.width.data(), * __restrict air = edges.air.data();
  const lanes::V3 mean{by.mean.x(), by.mean.y(), by.mean.z()};
  const double normal = by.normal, tangential = by.tangential;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const lanes::V3 edge{x[i], y[i], z[i]};
    const lanes::V3 flow = lanes::V3{vx[i], vy[i], vz[i]} - air[i] * mean;
    const double length = lanes::norm(edge);
    const lanes::V3 e = (1.0 / length) * edge;
    const double q = lanes::dot(e, flow);
    const lanes::V3 across = flow - q * e;
    const double size = width[i] * length;
    const lanes::V3 half =
        (size * normal * lanes::norm(across)) * across + (size * tangential * std::fabs(q) * q) * e;
    x[i] = half.x;
    y[i] = half.y;
    z[i] = half.z;
  }
}

}  // namespace

void drag(const DragPerLength& by, std::size_t count, ExposedEdges& edges) {
  drag_of(by, count, edges);
}

}  // namespace tendril
