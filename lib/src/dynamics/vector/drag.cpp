#include "drag.h"

#include "lanes.h"

namespace tendril {
namespace {

TENDRIL_LANES void expose_edges(const double* __restrict p, const double* __restrict v,
                                const double* __restrict width, const Vec3& by, std::size_t count,
                                ExposedEdges& to) {
  const lanes::V3 half{0.5 * by.x(), 0.5 * by.y(), 0.5 * by.z()};
  double* __restrict x = to.x.data(), * __restrict y = to.y.data(), * __restrict z = to.z.data();
  double* __restrict vx = to.vx.data(), * __restrict vy = to.vy.data(), * __restrict vz = to.vz.data();
  double* __restrict wide = to.width.data(), * __restrict delay = to.delay.data();
  TENDRIL_LOOP
  for (std::size_t k = 0; k < count; ++k) {
    const lanes::V3 a{p[3 * k], p[3 * k + 1], p[3 * k + 2]};
    const lanes::V3 b{p[3 * k + 3], p[3 * k + 4], p[3 * k + 5]};
    x[k] = b.x - a.x;
    y[k] = b.y - a.y;
    z[k] = b.z - a.z;
    delay[k] = lanes::dot(half, a + b);
    vx[k] = 0.5 * (v[3 * k] + v[3 * k + 3]);
    vy[k] = 0.5 * (v[3 * k + 1] + v[3 * k + 4]);
    vz[k] = 0.5 * (v[3 * k + 2] + v[3 * k + 5]);
    wide[k] = width[k];
  }
}

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
    const bool exposed = length > 0.0 && width[i] > 0.0;
    const lanes::V3 e = (1.0 / (exposed ? length : 1.0)) * edge;
    const double q = lanes::dot(e, flow);
    const lanes::V3 across = flow - q * e;
    const double size = exposed ? width[i] * length : 0.0;
    const lanes::V3 half =
        (size * normal * lanes::norm(across)) * across + (size * tangential * std::fabs(q) * q) * e;
    x[i] = half.x;
    y[i] = half.y;
    z[i] = half.z;
  }
}

TENDRIL_INLINE void add_to(const ExposedEdges& edges, std::size_t count, double* __restrict force) {
  const double* __restrict x = edges.x.data(), * __restrict y = edges.y.data(), * __restrict z = edges.z.data();
  TENDRIL_LOOP
  for (std::size_t k = 0; k < count; ++k) {
    force[3 * k] += x[k];
    force[3 * k + 1] += y[k];
    force[3 * k + 2] += z[k];
  }
}
TENDRIL_LANES void put_halves(const ExposedEdges& edges, std::size_t count, double* force) {
  add_to(edges, count, force);
  add_to(edges, count, force + 3);
}

}  // namespace

void expose(std::span<const Vec3> p, std::span<const Vec3> v, std::span<const double> width, const Vec3& by,
            ExposedEdges& edges) {
  expose_edges(p.front().data(), v.front().data(), width.data(), by, width.size(), edges);
}

void drag(const DragPerLength& by, std::size_t count, ExposedEdges& edges) {
  drag_of(by, count, edges);
}

void put_drag(const ExposedEdges& edges, std::span<Vec3> force) {
  put_halves(edges, force.size() - 1, force.front().data());
}

}  // namespace tendril
