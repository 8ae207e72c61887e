#pragma once

#include "draw/drawing.h"
#include "draw/ray_scene.h"

namespace tendril::runner {

/// Numbers in [0, 1) that depend on the pixel, the sample and the dimension alone: an additive recurrence by
/// the plastic number from a start that is hashed per pixel.
class Samples {
 public:
  Samples(int x, int y)
      : seed_(hash(static_cast<std::uint32_t>(x) * 0x9e3779b9U ^ hash(static_cast<std::uint32_t>(y)))) {}

  Eigen::Vector2f pair(int dimension, int index) const {
    const std::uint32_t h = hash(seed_ + static_cast<std::uint32_t>(dimension) * 0x85ebca6bU);
    return {fraction(h, 0xc13fa9a9U, index), fraction(hash(h), 0x91e10da5U, index)};
  }

 private:
  static std::uint32_t hash(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352dU;
    x = (x ^ (x >> 15)) * 0x846ca68bU;
    return x ^ (x >> 16);
  }
  static float fraction(std::uint32_t start, std::uint32_t step, int index) {
    return static_cast<float>((start + step * static_cast<std::uint32_t>(index)) >> 8) * 0x1p-24F;
  }
  std::uint32_t seed_;
};

/// What a ray from the eye meets, in coordinates (p - centre) / size.
struct Seen {
  enum class Kind : std::uint8_t { wall, ground, surface } kind = Kind::wall;
  bool strand = false;    ///< one lies on the way or behind
  float distance = 0.0F;  ///< along the ray
  float height = 0.0F;    ///< in the picture, -1 to 1: the wall's colour
  Vec3f at = Vec3f::Zero(), normal = Vec3f::Zero(), direction = Vec3f::Zero();
  Vec3f color = Vec3f::Zero();   ///< of the surface
  Vec3f bright = Vec3f::Zero();  ///< of the strand
  bool strand_hidden = false;
};

/// Casts rays: a sun with soft shadow, light from the sky that things near by keep off.
class Tracer {
 public:
  Tracer(const Drawing& drawing, const Camera& camera);

  /// \param x, y  in the picture, -1 to 1, right and up
  Seen look(float x, float y) const;
  /// Whether one ray to the sun, of sample s, gets there. False on what faces away from it and on the wall.
  bool sunlit(const Seen& seen, const Samples& samples, int s) const;
  /// Mean light from the sky over the hemisphere, weighted by the cosine, by rays first to first + count; 1
  /// in the open.
  float skylight(const Seen& seen, const Samples& samples, int first, int count) const;
  /// Linear light.
  /// \param sun  share of the sun that is seen, 0 to 1
  Vec3f shade(const Seen& seen, float sun, float sky) const;

 private:
  bool blocked(const Seen& seen, const Vec3f& towards, float reach) const;

  RayScene solid_, over_;
  bool has_over_;
  Vec3f eye_, right_, up_, forward_, ground_up_;
  float ground_;
  Vec3f sun_, sun_x_, sun_y_;
};

}  // namespace tendril::runner
