#pragma once

#include <tendril/bind/bind_options.h>
#include <tendril/bind/polygon_mesh.h>
#include <tendril/curve/closest_point.h>

#include <memory>
#include <optional>

/// The projections that bear on each point of a mesh, and the weights they come to.
namespace tendril::bind {

struct Candidate {
  std::uint32_t pair;
  LocalMinimum at;
  double factor = 1.0;  ///< on the distance, see Ways
  bool open = true;     ///< not gated

  double distance() const { return factor * at.distance; }
};

/// A place of an axis that points may be bound to besides their nearest projection.
struct Node {
  std::uint32_t pair;
  double t;
};

/// A node that a point is bound to.
struct Influence {
  std::uint32_t node;  ///< index
  double weight;
};

struct Branches {
  std::vector<Node> nodes;                         ///< of all curves, ascending
  std::vector<Candidate> nearest;                  ///< per point, of those not gated
  std::vector<std::vector<Influence>> influences;  ///< per point, none where the nearest alone counts
  std::vector<std::uint32_t> ambiguous, gated;
  std::vector<LoosePart> loose;
  std::size_t clusters = 0;
};

/// What the points of a body are bound to, as a function of their place: found once at the nodes of a grid
/// about its surface, and interpolated. So it does not depend on how the surface is cut into faces.
class BodyBranches {
 public:
  /// \param projectors  kept by reference
  /// \param body        valid
  /// \param band        see BindOptions
  BodyBranches(std::span<const CurveProjector> projectors, const PolygonMesh& body, double band, int threads);
  ~BodyBranches();

  /// \param points  on the surface of the body
  /// \param face of the body, that each point is on (BodyGrid::place); or none, where the points are the
  ///                  body's own
  Branches find(Points points, std::span<const std::uint32_t> face, int threads) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Of a mesh's own points.
/// \param band  see BindOptions
Branches find_branches(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band,
                       int threads);

}  // namespace tendril::bind
