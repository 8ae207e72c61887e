#pragma once

#include <tendril/curve/closest_point.h>

#include "mesh/neighbours.h"

/// Which curve-pairs a point may be inside of.
namespace tendril::bind {

/// Factors on the distances from the points of a mesh to several curves. A body's skin that an arm hangs
/// beside is nearer to the arm's axis than to the body's own, but its faces look towards the arm's, not away
/// from it as those of the arm do: there the distance to the arm counts for up to ten times as much.
///
/// 1 where the faces look away from the curve, as most of the mesh's do from the curves nearest to them, or
/// across. The logarithm grows by at most 1 over a way along the edges as long as the distance to
/// the curve, from wherever it is 0, so that folds of a limb do not count, and nothing jumps: in an armpit
/// the skin passes gradually from one to the other.
class Facing {
 public:
  /// All 1 when there is one curve, or when no side of the mesh is the outside (a sheet that the curves lie
  /// in).
  Facing(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, const Neighbours& neighbours,
         int threads);

  double factor(std::size_t point, std::uint32_t pair) const {
    return factor_.empty() ? 1.0 : static_cast<double>(factor_[point * pairs_ + pair]);
  }

 private:
  void look(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, int threads);
  void soften(std::uint32_t pair, const PolygonMesh& mesh, const Neighbours& neighbours);

  std::size_t pairs_;
  std::vector<float> factor_;    ///< per point and curve; while this is made, the logarithm
  std::vector<float> distance_;  ///< per point and curve, while this is made
};

}  // namespace tendril::bind
