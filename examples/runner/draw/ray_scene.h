#pragma once

#include "draw/drawing.h"

#include <memory>
#include <optional>

namespace tendril::runner {

/// What a ray meets first.
struct Hit {
  float distance;
  Vec3f normal;  ///< unit, towards the ray's origin; the smooth one
  Vec3f flat;    ///< unit, of the surface itself, towards the origin
  Vec3f color;
};

/// Solid things and strands in Embree's hands, in coordinates (p - centre) / size.
class RayScene {
 public:
  RayScene(const bind::PolygonMesh* mesh, std::span<const Strand> strands, const Vec3& centre, double size);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  std::optional<Hit> nearest(const Vec3f& origin, const Vec3f& direction) const;
  /// True when something lies within `reach` of the origin.
  bool blocked(const Vec3f& origin, const Vec3f& direction, float reach) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril::runner
