// Bullet, as packaged in single precision: GJK with penetration depths by EPA, of hulls without a margin.
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <cmath>

#include "accuracy/collision/adapter.h"

namespace tendril::suite {
namespace {

class Hull : public btConvexHullShape {
 public:
  explicit Hull(std::span<const Vec3> points) {
    for (const Vec3& x : points)
      addPoint({static_cast<btScalar>(x.x()), static_cast<btScalar>(x.y()), static_cast<btScalar>(x.z())},
               false);
    setMargin(0);
    recalcLocalAabb();
  }
};

btPointCollector closest(std::span<const Vec3> a, std::span<const Vec3> b) {
  const Hull first(a), second(b);
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btGjkPairDetector detector(&first, &second, &simplex, &depth);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA.setIdentity();
  input.m_transformB.setIdentity();
  btPointCollector out;
  detector.getClosestPoints(input, out, nullptr);
  return out;
}

Said meet(std::span<const Vec3> a, std::span<const Vec3> b) {
  const btPointCollector found = closest(a, b);
  if (!found.m_hasResult) return {};
  return found.m_distance <= 0;
}

}  // namespace

Adapter bullet_adapter() {
  Adapter out{"Bullet, float"};
  out.proper = true;
  out.triangles = [](const Corners& a, const Corners& b) { return meet(a, b); };
  out.segment = [](const Corners& a, const Ends& s) { return meet(a, s); };
  out.distance = [](const Corners& a, const Corners& b) {
    const btPointCollector found = closest(a, b);
    return found.m_hasResult ? std::max(0.0, static_cast<double>(found.m_distance)) : std::nan("");
  };
  return out;
}

}  // namespace tendril::suite
