#include "posed_sets.h"

#include <limits>

namespace tendril::contact {
namespace {

// Of a set's diagonal: what single precision leaves open of a vertex' reach, some ten roundings, and of a
// direction's length.
constexpr double kOpen = 2e-6;
// Larger ones might overflow there: they are apart from nothing.
constexpr double kMostSize = 1e30;

Direction back(const Direction& n) {
  return {-n[0], -n[1], -n[2]};
}

}  // namespace

/// n . x of all.
PosedSets::Some PosedSets::reach(const Block& of, const Direction& n) {
  return n[0] * of.x + n[1] * of.y + n[2] * of.z;
}

float PosedSets::least(std::size_t set, std::size_t end, const Direction& n) const {
  const Block* of = block(set, end);
  Some least = reach(*of, n);
  for (std::size_t i = 1; i < blocks(set); ++i) least = least.min(reach(of[i], n));
  return least.minCoeff();
}

PosedSets::Nearest PosedSets::nearest(std::size_t set, std::size_t end, const Direction& n) const {
  const Block* of = block(set, end);
  Some best = reach(*of, n);
  float least = best.minCoeff();
  std::size_t where = 0;
  for (std::size_t i = 1; i < blocks(set); ++i) {
    const Some here = reach(of[i], n);
    const float nearest = here.minCoeff();
    if (nearest < least) least = nearest, best = here, where = i;
  }
  Eigen::Index k = 0;
  while (k + 1 < best.size() && best[k] > least) ++k;
  return {least, sets_.vertices[sets_.begin[set] + where * kLane + static_cast<std::size_t>(k)]};
}

PosedSets::PosedSets(const VertexSets& sets, std::span<const Vec3> at, std::span<const Vec3> after)
    : sets_(sets),
      at_{at, after},
      ends_(at.data() == after.data() ? 1 : 2),
      about_(sets.size() * ends_),
      blocks_(std::make_unique_for_overwrite<Block[]>(sets.vertices.size() / kLane * ends_)) {}

void PosedSets::take(std::size_t begin, std::size_t end) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (std::size_t set = begin; set < end; ++set) {
    const std::uint32_t* vertex = &sets_.vertices[sets_.begin[set]];
    const std::size_t count = blocks(set);
    Block* to = &blocks_[sets_.begin[set] / kLane * ends()];
    for (std::size_t which = 0; which < ends(); ++which) {
      const Vec3* at = at_[which].data();
      const Vec3 first = at[vertex[0]];
      Vec3 low = first, high = first;
      for (std::size_t i = 0; i < count; ++i, ++to)
        for (std::size_t k = 0; k < kLane; ++k) {
          const Vec3& here = at[vertex[i * kLane + k]];
          low = low.cwiseMin(here);
          high = high.cwiseMax(here);
          const auto lane = static_cast<Eigen::Index>(k);
          to->x[lane] = static_cast<float>(here.x() - first.x());
          to->y[lane] = static_cast<float>(here.y() - first.y());
          to->z[lane] = static_cast<float>(here.z() - first.z());
        }
      const double size = (high - low).norm();
      about_[set * ends() + which] = {{low, high}, first, size < kMostSize ? size : infinite};
    }
  }
}

Vec3 PosedSets::middle(std::size_t set) const {
  const collision::Box &first = box(set, 0), &last = box(set, ends() - 1);
  return 0.25 * (first.low + first.high + last.low + last.high);
}

double PosedSets::apart(const About& p, const About& q, const Direction& n, double both) const {
  const Vec3 way = p.first - q.first;
  const double apart = way.dot(Eigen::Vector3f(n[0], n[1], n[2]).cast<double>()) + both;
  return apart * (1.0 - kOpen) - kOpen * (p.size + q.size) - 1e-14 * way.cwiseAbs().maxCoeff();
}

bool PosedSets::part(std::size_t p, std::size_t q, const Direction& n, double far) const {
  for (std::size_t end = 0; end < ends(); ++end) {
    const double both = static_cast<double>(least(p, end, n)) + static_cast<double>(least(q, end, back(n)));
    if (!(apart(about(p, end), about(q, end), n, both) > far)) return false;
  }
  return true;
}

PosedSets::Along PosedSets::along(std::size_t p, std::size_t q, const Direction& n, std::size_t end) const {
  const Nearest low = nearest(p, end, n), high = nearest(q, end, back(n));
  const double both = static_cast<double>(low.reach) + static_cast<double>(high.reach);
  return {apart(about(p, end), about(q, end), n, both), at_[end][low.vertex] - at_[end][high.vertex]};
}

}  // namespace tendril::contact
