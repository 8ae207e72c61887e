#pragma once

#include <tendril/curve/closest_point.h>

#include <cmath>

#include "curve_distances.h"

namespace tendril::bind {

/// Factors, 1 to 10, on the distances from points of a surface to several curves: how much longer the way
/// through the body is than the straight one. A body's skin that an arm hangs beside is nearer to the arm's
/// axis than to the body's own, but the way there leads round by the shoulder.
///
/// The factor is the square of the way over the distance, but at least 1 and at most 10, which it is where
/// there is no way; a way is taken as two voxels shorter than it is, and than 1 / 1.08 of it, so that what is
/// seen from the axis has the factor 1. Then log factor is lowered so that it grows between neighbour nodes
/// by at most their distance over that to the curve: in an armpit the factor changes gradually. All 1 of a
/// curve that no way leads from, as none of it is near the body, and at nodes that no curve has a way to.
class Ways {
 public:
  /// \param distances  of the grid's nodes
  Ways(std::span<const CurveProjector> projectors, BodyGrid& grid, const CurveDistances& distances,
       int threads);

  double factor(std::uint32_t node, std::uint32_t pair) const {
    return log_.empty() ? 1.0 : std::exp(log_[pair][node]);
  }
  double factor(const GridPlace& place, std::uint32_t pair) const {
    return log_.empty() ? 1.0 : std::exp(place.mean([&](std::uint32_t node) { return log_[pair][node]; }));
  }

 private:
  std::vector<std::vector<double>> log_;  ///< by curve and node; none for one curve
};

}  // namespace tendril::bind
