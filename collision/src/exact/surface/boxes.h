#pragma once

#include <tendril/collision/box_tree.h>

#include <cmath>
#include <limits>

#include "exact/crossing.h"

/// Boxes of shapes for queries of hierarchies.
namespace tendril::exact {

inline collision::Box moved_out(const collision::Box& box, double radius) {
  const auto margin = [radius](double x) {
    return (std::abs(x) + radius) * 4 * kEps + std::numeric_limits<double>::min();
  };
  collision::Box out = box;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = box.low[k] - radius - margin(box.low[k]);
    out.high[k] = box.high[k] + radius + margin(box.high[k]);
  }
  return out;
}

inline collision::Box box_about(const Shape& shape) {
  const collision::Box box = collision::box_of(points_of(shape));
  return compare(shape.radius, 0.0) > 0 ? moved_out(box, shape.radius) : box;
}

/// Never above the distance of anything in the two boxes. The norm where no square leaves the range of
/// doubles, else one coordinate's gap.
inline double boxes_apart(const collision::Box& a, const collision::Box& b) {
  const Vec3 gap = (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0);
  const double most = gap.maxCoeff();
  const bool plain = most > 0x1p-400 && most < 0x1p400;
  return (plain ? gap.norm() : most) * (1 - 16 * kEps);
}

}  // namespace tendril::exact
