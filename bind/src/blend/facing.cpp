#include "facing.h"

#include <algorithm>
#include <cmath>

#include "mesh/parallel.h"

namespace tendril::bind {
namespace {

constexpr double kMost = 2.302585092994046;    ///< log 10
constexpr double kSlope = 1.0;                 ///< of the logarithm, by length over distance
constexpr double kAcross = 0.3, kFull = -0.1;  ///< cosines at which the factor begins to grow, and is full
constexpr double kClear = 0.2;                 ///< share of the surface that must agree on a side

/// Sums of the neighbouring faces' normals, as long as the faces are large.
std::vector<Vec3> normals(const PolygonMesh& mesh) {
  std::vector<Vec3> out(mesh.points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const Vec3& p = mesh.points[face[0]];
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < face.size(); ++k)
      normal += (mesh.points[face[k - 1]] - p).cross(mesh.points[face[k]] - p);
    for (const std::uint32_t i : face) out[i] += normal;
  }
  return out;
}

/// Logarithm of the factor, by the cosine between the normal and the direction from the curve.
double penalty(double cosine) {
  const double s = std::clamp((kAcross - cosine) / (kAcross - kFull), 0.0, 1.0);
  return kMost * s * s * (3.0 - 2.0 * s);
}

}  // namespace

Facing::Facing(std::span<const CurveProjector> projectors, const PolygonMesh& mesh,
               const Neighbours& neighbours, int threads)
    : pairs_(projectors.size()) {
  if (pairs_ < 2) return;
  measure(projectors, mesh, threads);
  if (factor_.empty()) return;
  in_parts(pairs_, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) bound_slope(static_cast<std::uint32_t>(k), mesh, neighbours);
  });
  for (float& f : factor_) f = std::exp(f);
  distance_ = {};
}

/// Distances and cosines, and which side is the outside.
void Facing::measure(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, int threads) {
  const std::vector<Vec3> normal = normals(mesh);
  factor_.resize(mesh.points.size() * pairs_);
  distance_.resize(factor_.size());
  in_parts(mesh.points.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < pairs_; ++k) {
      const std::vector<Projection> nearest =
          projectors[k].nearest(Points(mesh.points).subspan(begin, end - begin));
      for (std::size_t i = begin; i < end; ++i) {
        const Projection& at = nearest[i - begin];
        const double scale = at.distance * normal[i].norm();
        const double cosine = scale > 0.0 ? (mesh.points[i] - at.point).dot(normal[i]) / scale : 0.0;
        factor_[i * pairs_ + k] = static_cast<float>(cosine);
        distance_[i * pairs_ + k] = static_cast<float>(at.distance);
      }
    }
  });
  double away = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const auto first = distance_.begin() + static_cast<std::ptrdiff_t>(i * pairs_);
    const auto nearest = std::min_element(first, first + static_cast<std::ptrdiff_t>(pairs_));
    away += static_cast<double>(factor_[static_cast<std::size_t>(nearest - distance_.begin())]) *
            normal[i].norm();
    weight += normal[i].norm();
  }
  if (!(std::abs(away) > kClear * weight)) {
    factor_ = {};
    distance_ = {};
    return;
  }
  for (float& f : factor_) f = static_cast<float>(penalty(std::copysign(1.0, away) * static_cast<double>(f)));
}

void Facing::bound_slope(std::uint32_t pair, const PolygonMesh& mesh, const Neighbours& neighbours) {
  bound_growth(
      mesh, neighbours, [&](std::uint32_t i) -> float& { return factor_[i * pairs_ + pair]; },
      [&](std::uint32_t i, double length) {
        return kSlope * length / std::max(1e-30, static_cast<double>(distance_[i * pairs_ + pair]));
      });
}

}  // namespace tendril::bind
