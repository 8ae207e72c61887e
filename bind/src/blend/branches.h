#pragma once

#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/closest_point.h>

#include <optional>

/// The projections that bear on each point of a mesh, and the weights they come to.
namespace tendril::bind {

struct Candidate {
  std::uint32_t pair;
  LocalMinimum at;
  double factor = 1.0;  ///< on the distance, see Facing
  bool open = true;     ///< not gated

  double distance() const { return factor * at.distance; }
};

/// A node of an axis that a point is bound to.
struct Influence {
  std::uint32_t pair;
  double t, weight;
};

struct Branches {
  std::vector<Candidate> nearest;                  ///< per point, of those not gated
  std::vector<std::vector<Influence>> influences;  ///< per point, none where the nearest alone counts
  std::vector<std::uint32_t> ambiguous, gated;
  std::size_t clusters = 0;
};

/// \param band  see BindOptions
Branches find_branches(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band,
                       int threads);

}  // namespace tendril::bind
