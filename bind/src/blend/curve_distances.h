#pragma once

#include <tendril/curve/closest_point.h>

#include "body_grid.h"

namespace tendril::bind {

/// Distances from the nodes of a grid to several curves, and what they say of points in between: a distance
/// changes by at most the way. So of many curves only the few that may count for a point are looked at.
class CurveDistances {
 public:
  CurveDistances(std::span<const CurveProjector> projectors, Points nodes, int threads);

  std::size_t curves() const { return of_.size(); }
  /// By node.
  const std::vector<double>& to(std::uint32_t curve) const { return of_[curve]; }

  struct Bounds {
    double least, most;
  };
  /// Of a point.
  /// \param node  near it
  /// \param away  its distance from that node; 0 for the node itself, whose distance both bounds are
  Bounds bounds(std::uint32_t curve, std::uint32_t node, double away) const {
    const double at = of_[curve][node], room = away > 0.0 ? away + kRoom * (at + away) : 0.0;
    return {std::max(0.0, at - room), at + room};
  }

 private:
  static constexpr double kRoom = 1e-9;  ///< for rounding, relative
  std::vector<std::vector<double>> of_;  ///< by curve and node
};

}  // namespace tendril::bind
