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

  /// What lies at places in the picture, -1 to 1, right and up.
  /// \param places, out  as many of both, at most kBundle, and best close to each other
  void look(std::span<const Eigen::Vector2f> places, std::span<Seen> out) const;
  /// Whether one ray to the sun gets there, of each place. False on what faces away from it and on the wall.
  /// \param samples  of the sun's disc, in [0, 1); as many as seen and out, at most kBundle
  void sunlit(std::span<const Seen> seen, std::span<const Eigen::Vector2f> samples,
              std::span<std::uint8_t> out) const;
  /// Mean light from the sky over the hemisphere, weighted by the cosine, by `count` rays; 1 in the open.
  float skylight(const Seen& seen, const Samples& samples, int count) const;
  /// Linear light.
  /// \param sun  share of the sun that is seen, 0 to 1
  Vec3f shade(const Seen& seen, float sun, float sky) const;

 private:
  Seen describe(const Vec3f& direction, float height, const std::optional<Hit>& hit) const;
  Vec3f to_sun(const Eigen::Vector2f& sample) const;

  RayScene solid_, over_;
  bool has_over_;
  Vec3f eye_, right_, up_, forward_, ground_up_;
  float ground_;
  Vec3f sun_, sun_x_, sun_y_;
};

}  // namespace tendril::runner
