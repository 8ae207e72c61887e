#pragma once

#include <tendril/base/types.h>
#include <tendril/collision/hierarchy_options.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tendril::bench {

/// A hierarchy over a mesh that is told all new positions, then asked for the triangles within a ball.
class BallPeer {
 public:
  virtual ~BallPeer() = default;
  virtual void move(Points at) = 0;
  /// Number of triangles that the ball meets; or 1 for some and 0 for none, where that is all it says.
  virtual std::size_t count(const Vec3& centre, double radius) = 0;
};

/// Null where the peer is not installed; then the name says so.
struct NamedPeer {
  std::string name;
  std::unique_ptr<BallPeer> peer;
  bool counts = true;  ///< false: some or none
};
using Triangles = std::span<const collision::Triangle>;
NamedPeer own_refit(Points rest, Triangles triangles);
NamedPeer embree_refit(Points rest, Triangles triangles);
NamedPeer cgal_rebuild(Points rest, Triangles triangles);
NamedPeer fcl_obbrss_refit(Points rest, Triangles triangles);

/// Square of the distance between a point and a triangle.
double square_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tendril::bench
