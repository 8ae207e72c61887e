#include "capsule_tree.h"

#include <algorithm>
#include <cmath>

namespace tendril {

Capsule around(Points points) {
  Capsule capsule{points.front(), points.back() - points.front(), 0.0, 0.0};
  const double length2 = capsule.axis.squaredNorm();
  if (length2 > 0.0 && std::isfinite(1.0 / length2)) capsule.inverse_length2 = 1.0 / length2;
  double radius = 0.0;
  for (const Vec3& p : points) radius = std::max(radius, capsule.distance(p));
  capsule.radius = radius;
  return capsule;
}

namespace {

/// The same for a Bezier piece of degree n, where the curve allows a smaller radius than its control points
/// P_i. The segment is the Bezier curve with the points start + i / n axis, so c(t) differs from its point at
/// t by sum_i B_i(t) (P_i - start - i / n axis). The terms i = 0 and i = n vanish, and the weights of the
/// others sum to 1 - t^n - (1 - t)^n <= 1 - 2^(1 - n), attained at t = 1/2.
Capsule around_piece(Points points) {
  Capsule capsule = around(points);
  const double n = static_cast<double>(points.size() - 1);
  double most = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    most = std::max(most, (points[i] - capsule.start - static_cast<double>(i) / n * capsule.axis).norm());
  capsule.radius = std::min(capsule.radius, (1.0 - std::exp2(1.0 - n)) * most * (1.0 + 1e-15));
  return capsule;
}

}  // namespace

CapsuleTree::CapsuleTree(Points points, std::size_t per_piece) {
  nodes_.reserve(2 * (points.size() / per_piece) - 1);
  build(points, per_piece, 0);
}

void CapsuleTree::build(Points points, std::size_t per_piece, std::size_t first) {
  const std::size_t node = nodes_.size();
  const std::size_t count = points.size() / per_piece;
  nodes_.push_back({count == 1 ? around_piece(points) : around(points), 0, first});
  if (count == 1) {
    leaves_.push_back(node);
    return;
  }
  const std::size_t half = count / 2;
  build(points.first(half * per_piece), per_piece, first);
  nodes_[node].right = nodes_.size();
  build(points.subspan(half * per_piece), per_piece, first + half);
}

}  // namespace tendril
