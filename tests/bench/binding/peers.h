#pragma once

#include <tendril/curve/bspline.h>

#include <memory>
#include <string>

namespace tendril::bench {

/// A peer's nearest point on a curve: the distance; infinite when it has no answer.
class Projector {
 public:
  virtual ~Projector() = default;
  virtual double distance(const Vec3& p) = 0;
};

/// Null where the peer is not installed; then the name says so.
struct ProjectionPeer {
  std::string name;
  double goal;  ///< ours is to be so many times faster, in the geometric mean
  std::unique_ptr<Projector> projector;
};
ProjectionPeer occt_projector(const BSpline& curve);
ProjectionPeer sisl_s1953(const BSpline& curve);
ProjectionPeer sisl_s1957(const BSpline& curve);

}  // namespace tendril::bench
