#include "capsule_tree.h"

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

Capsule around(Points points) {
  Capsule capsule{points.front(), points.back() - points.front(), 0.0, 0.0};
  const double length2 = capsule.axis.squaredNorm();
  if (length2 > 0.0 && std::isfinite(1.0 / length2)) capsule.inverse_length2 = 1.0 / length2;
  double radius = 0.0;
  for (const Vec3& p : points) radius = std::max(radius, capsule.distance(p));
  capsule.radius = radius;
  return capsule;
}

}  // namespace

CapsuleTree::CapsuleTree(Points points, std::size_t per_piece) {
  nodes_.reserve(2 * (points.size() / per_piece) - 1);
  build(points, per_piece, 0);
}

void CapsuleTree::build(Points points, std::size_t per_piece, std::size_t first) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({around(points), 0, first});
  const std::size_t count = points.size() / per_piece;
  if (count == 1) return;
  const std::size_t half = count / 2;
  build(points.first(half * per_piece), per_piece, first);
  nodes_[node].right = nodes_.size();
  build(points.subspan(half * per_piece), per_piece, first + half);
}

}  // namespace tendril
