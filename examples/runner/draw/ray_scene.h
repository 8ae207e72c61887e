#pragma once

#include "draw/drawing.h"

#include <cstdint>
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

constexpr std::size_t kBundle = 8;  ///< the most rays that go through the scene together

/// Solid things and strands in Embree's hands, in coordinates (p - centre) / size.
class RayScene {
 public:
  RayScene(const bind::PolygonMesh* mesh, std::span<const Strand> strands, const Vec3& centre, double size);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// What rays from one origin meet, a direction each.
  /// \param directions  unit, at most kBundle, and best close to each other
  void nearest(const Vec3f& origin, std::span<const Vec3f> directions,
               std::span<std::optional<Hit>> hits) const;
  /// Bit k tells whether something lies within `reach` of the k-th origin.
  /// \param origins, directions  as many of both, at most kBundle
  std::uint32_t blocked(std::span<const Vec3f> origins, std::span<const Vec3f> directions, float reach) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace tendril::runner
