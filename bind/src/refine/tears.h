#pragma once

#include <tendril/bind/judge.h>

#include "place/surface_binder.h"

namespace tendril::bind {

/// A piece of an edge, at rest and posed.
struct Piece {
  std::array<Vec3, 2> rest, posed;
  std::uint32_t face;  ///< of the body, that it is on

  double gap() const { return (posed[1] - posed[0]).norm(); }
  double length() const { return (rest[1] - rest[0]).norm(); }
};

/// What becomes of pieces that are halved again and again, always the half whose ends are farther apart when
/// posed being kept.
struct Limits {
  std::vector<Tear> tears;  ///< in the order of the pieces
  double steepest = 0.0;    ///< largest stretch where none tears
};

/// Where the map of the surface is continuous, the ends of a piece come together as it gets shorter, at the
/// latest where its stretch has reached its bound; where it jumps they stay apart by the jump. So a piece is
/// left as soon as its ends are less than `least_gap` apart, and torn where they are not when it is shorter
/// than `shortest`.
Limits find_limits(const SurfaceBinder& binder, std::span<const CurvePair> posed, std::vector<Piece> pieces,
                   double least_gap, double shortest, int threads);

}  // namespace tendril::bind
