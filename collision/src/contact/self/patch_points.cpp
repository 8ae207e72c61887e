#include "patch_points.h"

#include <algorithm>
#include <limits>

namespace tendril::contact {
namespace {

// Of a patch's diagonal: what single precision leaves open of a corner's reach, some ten roundings, and of a
// direction's length.
constexpr double kOpen = 2e-6;

constexpr std::size_t kLane = SelfMesh::kLane, kAtATime = 32;

}  // namespace

PatchPoints::PatchPoints(const SelfMesh& mesh, std::span<const Vec3> at)
    : mesh_(mesh), at_(at), boxes_(mesh.patches.size()) {
  x_.resize(mesh.padded.size());
  y_.resize(mesh.padded.size());
  z_.resize(mesh.padded.size());
  for (std::size_t p = 0; p < boxes_.size(); ++p) {
    const std::size_t begin = mesh.padded_begin[p], end = mesh.padded_begin[p + 1];
    const Vec3 first = at[mesh.padded[begin]];
    Vec3 low = first, high = first;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& x = at[mesh.padded[i]];
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
      x_[i] = static_cast<float>(x.x() - first.x());
      y_[i] = static_cast<float>(x.y() - first.y());
      z_[i] = static_cast<float>(x.z() - first.z());
    }
    boxes_[p] = {low, high};
  }
}

double PatchPoints::between(std::size_t p, std::size_t q, const Direction& n) const {
  const Vec3 way = at_[mesh_.padded[mesh_.padded_begin[p]]] - at_[mesh_.padded[mesh_.padded_begin[q]]];
  return way.dot(Eigen::Vector3f(n[0], n[1], n[2]).cast<double>());
}

double PatchPoints::surely(std::size_t p, std::size_t q, double apart) const {
  const double size = (boxes_[p].high - boxes_[p].low).norm() + (boxes_[q].high - boxes_[q].low).norm();
  const double way = (boxes_[p].low - boxes_[q].low).cwiseAbs().maxCoeff();
  return apart * (1.0 - kOpen) - kOpen * size - 1e-14 * way;
}

double PatchPoints::apart(std::size_t p, std::size_t q, const Direction& n) const {
  const auto reach = [&](std::size_t patch, float sign) {
    std::array<float, kLane> least;
    least.fill(std::numeric_limits<float>::infinity());
    const float a = sign * n[0], b = sign * n[1], c = sign * n[2];
    for (std::size_t i = mesh_.padded_begin[patch]; i < mesh_.padded_begin[patch + 1]; i += kLane)
      for (std::size_t k = 0; k < kLane; ++k) {
        const float to = a * x_[i + k] + b * y_[i + k] + c * z_[i + k];
        least[k] = to < least[k] ? to : least[k];
      }
    return *std::min_element(least.begin(), least.end());
  };
  const double low = static_cast<double>(reach(p, 1.0F)), high = -static_cast<double>(reach(q, -1.0F));
  return surely(p, q, between(p, q, n) + low - high);
}

PatchPoints::Along PatchPoints::along(std::size_t p, std::size_t q, const Direction& n) const {
  const auto nearest = [&](std::size_t patch, float sign) {
    const float a = sign * n[0], b = sign * n[1], c = sign * n[2];
    std::array<float, kAtATime> to;
    const std::size_t begin = mesh_.padded_begin[patch], count = mesh_.padded_begin[patch + 1] - begin;
    float least = std::numeric_limits<float>::infinity();
    std::size_t which = 0;
    for (std::size_t from = 0; from < count; from += kAtATime) {
      const std::size_t some = std::min(kAtATime, count - from);
      for (std::size_t k = 0; k < some; ++k) {
        const std::size_t i = begin + from + k;
        to[k] = a * x_[i] + b * y_[i] + c * z_[i];
      }
      for (std::size_t k = 0; k < some; ++k)
        if (to[k] < least) least = to[k], which = from + k;
    }
    return std::pair(static_cast<double>(least), mesh_.padded[begin + which]);
  };
  const auto [low, of_p] = nearest(p, 1.0F);
  const auto [high, of_q] = nearest(q, -1.0F);
  return {surely(p, q, between(p, q, n) + low + high), of_p, of_q};
}

}  // namespace tendril::contact
