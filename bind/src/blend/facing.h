#pragma once

#include <tendril/curve/closest_point.h>

#include "mesh/neighbours.h"

/// Which curve-pairs a point may be inside of.
namespace tendril::bind {

/// Factors, 1 to 10, on the distances from the points of a mesh to several curves. A body's skin that an arm
/// hangs beside is nearer to the arm's axis than to the body's own, but it faces towards the arm's axis, not
/// away from it as the skin of the arm does.
///
/// With a the cosine between the outward normal at a point and the direction from its nearest point on a
/// curve to it, the factor is 1 for a >= 0.3, 10 for a <= -0.1, and log factor a smooth step in between. Then
/// log factor is lowered so that along each edge it grows by at most the edge's length over the distance to
/// the curve at its end. So the folds of a limb, a short path from skin that faces away, hardly count, and
/// nothing jumps: in an armpit the factor changes gradually.
class Facing {
 public:
  /// All 1 when there is one curve, or when the mesh does not tell which of its sides is the outside: the
  /// mean of a, over the nearest curves and weighted by area, is within 0.2 of 0 (a sheet that the curves lie
  /// in).
  Facing(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, const Neighbours& neighbours,
         int threads);

  double factor(std::size_t point, std::uint32_t pair) const {
    return factor_.empty() ? 1.0 : static_cast<double>(factor_[point * pairs_ + pair]);
  }

 private:
  /// Distances, and factors by the cosines; no factors where the outside is not known.
  void measure(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, int threads);
  /// Lowers the logarithms of one curve.
  void bound_slope(std::uint32_t pair, const PolygonMesh& mesh, const Neighbours& neighbours);

  std::size_t pairs_;
  std::vector<float> factor_;    ///< per point and curve; while this is made, the logarithm
  std::vector<float> distance_;  ///< per point and curve, while this is made
};

}  // namespace tendril::bind
