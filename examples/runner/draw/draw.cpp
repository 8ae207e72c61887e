#include "draw/drawing.h"
#include "draw/ray_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

namespace tendril::runner {
namespace {

constexpr float kEpsilon = 2e-4F;      // of the size of what is seen: lifts secondary rays off their surface
constexpr float kSunRadius = 0.09F;    // tangent of the sun's half angle: how soft shadows are
constexpr float kSkyReach = 0.7F;      // of the size: what is farther away does not darken
constexpr int kSkyRays = 2;            // per sample
constexpr float kBounce = 0.22F;       // light that comes from a neighbouring surface instead of the sky
constexpr float kGroundLight = 0.55F;  // and from the ground

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

struct Axes {
  Vec3f x, y;
};

Axes across(const Vec3f& z) {
  const Vec3f other = std::abs(z.x()) < 0.7F ? Vec3f::UnitX() : Vec3f::UnitY();
  const Vec3f x = z.cross(other).normalized();
  return {x, z.cross(x)};
}

class Tracer {
 public:
  Tracer(const Drawing& drawing, const Camera& camera, const scene::ViewOptions& view)
      : solid_(drawing.mesh, drawing.solid, camera.centre, camera.size),
        over_(nullptr, drawing.over, camera.centre, camera.size),
        has_over_(!drawing.over.empty()),
        view_(view),
        eye_(((camera.eye - camera.centre) / camera.size).cast<float>()),
        right_((camera.right * camera.tan_x).cast<float>()),
        up_((camera.up * camera.tan_y).cast<float>()),
        forward_(camera.forward.cast<float>()),
        ground_up_(camera.ground_up.cast<float>()),
        ground_(static_cast<float>((camera.ground - camera.centre.dot(camera.ground_up)) / camera.size)),
        sun_(
            (0.9 * camera.ground_up - 0.45 * camera.right - 0.5 * camera.forward).normalized().cast<float>()),
        sun_across_(across(sun_)) {}

  Vec3f pixel(int x, int y) const {
    const Samples samples(x, y);
    Vec3f sum = Vec3f::Zero();
    for (int s = 0; s < view_.samples; ++s) {
      const Eigen::Vector2f jitter = samples.pair(0, s);
      const float px = 2.0F * (static_cast<float>(x) + jitter.x()) / static_cast<float>(view_.width) - 1.0F;
      const float py = 1.0F - 2.0F * (static_cast<float>(y) + jitter.y()) / static_cast<float>(view_.height);
      sum += radiance((forward_ + px * right_ + py * up_).normalized(), py, samples, s);
    }
    return sum / static_cast<float>(view_.samples);
  }

 private:
  Vec3f radiance(const Vec3f& direction, float height, const Samples& samples, int s) const {
    const std::optional<Hit> hit = solid_.nearest(eye_, direction);
    const Vec3f below =
        hit ? surface(*hit, direction, samples, s) : background(direction, height, samples, s);
    if (!has_over_) return below;
    const std::optional<Hit> strand = over_.nearest(eye_, direction);
    if (!strand) return below;
    const float facing = 0.35F + 0.65F * std::max(0.0F, -strand->normal.dot(direction));
    const Vec3f bright = strand->color * (1.3F * facing);
    const bool hidden = hit && hit->distance < strand->distance;
    return hidden ? Vec3f(0.45F * below + 0.55F * bright) : bright;
  }

  Vec3f surface(const Hit& hit, const Vec3f& direction, const Samples& samples, int s) const {
    const Vec3f at = eye_ + hit.distance * direction + kEpsilon * hit.flat;
    const float facing = std::max(0.0F, hit.normal.dot(sun_));
    const float sun = facing > 0.0F ? facing * sunlight(at, samples, s) : 0.0F;
    const Vec3f sun_color(1.50F, 1.40F, 1.26F), sky_color(0.56F, 0.61F, 0.68F);
    const Vec3f diffuse =
        hit.color.cwiseProduct(sun * sun_color + skylight(at, hit.normal, samples, s) * sky_color);
    const Vec3f half = (sun_ - direction).normalized();
    const float gloss =
        0.06F * std::pow(std::max(0.0F, half.dot(hit.normal)), 24.0F) * (sun > 0.0F ? 1.0F : 0.0F);
    return diffuse + Vec3f::Constant(gloss);
  }

  /// A pale wall, and the ground that takes its colour and darkens only where light is kept from it.
  Vec3f background(const Vec3f& direction, float height, const Samples& samples, int s) const {
    const float blend = 0.5F * (height + 1.0F);
    const Vec3f wall = (1.0F - blend) * Vec3f(0.86F, 0.85F, 0.83F) + blend * Vec3f(0.80F, 0.84F, 0.88F);
    const float down = direction.dot(ground_up_);
    const float above = eye_.dot(ground_up_) - ground_;
    if (!(down < 0.0F) || !(above > 0.0F)) return wall;
    const Vec3f at = eye_ + (above / -down) * direction + kEpsilon * ground_up_;
    if (at.norm() > 4.0F) return wall;
    const float sun = sunlight(at, samples, s);
    const float sky = skylight(at, ground_up_, samples, s);
    return wall * ((0.58F + 0.42F * sun) * (0.35F + 0.65F * sky));
  }

  float sunlight(const Vec3f& at, const Samples& samples, int s) const {
    const Eigen::Vector2f u = samples.pair(1, s);
    const float radius = kSunRadius * std::sqrt(u.x()), angle = 2.0F * std::numbers::pi_v<float> * u.y();
    const Vec3f towards = sun_ + radius * (std::cos(angle) * sun_across_.x + std::sin(angle) * sun_across_.y);
    return solid_.blocked(at, towards.normalized(), 1e30F) ? 0.0F : 1.0F;
  }

  /// Mean light from the sky over the hemisphere, weighted by the cosine: 1 in the open.
  float skylight(const Vec3f& at, const Vec3f& normal, const Samples& samples, int s) const {
    const Axes axes = across(normal);
    float sum = 0.0F;
    for (int k = 0; k < kSkyRays; ++k) {
      const Eigen::Vector2f u = samples.pair(2, s * kSkyRays + k);
      const float radius = std::sqrt(u.x()), angle = 2.0F * std::numbers::pi_v<float> * u.y();
      const Vec3f towards = radius * (std::cos(angle) * axes.x + std::sin(angle) * axes.y) +
                            std::sqrt(std::max(0.0F, 1.0F - u.x())) * normal;
      if (solid_.blocked(at, towards, kSkyReach)) {
        sum += kBounce;
      } else {
        sum += towards.dot(ground_up_) < 0.0F ? kGroundLight : 1.0F;
      }
    }
    return sum / static_cast<float>(kSkyRays);
  }

  RayScene solid_, over_;
  bool has_over_;
  scene::ViewOptions view_;
  Vec3f eye_, right_, up_, forward_, ground_up_;
  float ground_;
  Vec3f sun_;
  Axes sun_across_;
};

/// \param dither  0 to 1, hides the steps of 8 bits in the pale background
std::uint8_t encode(float light, float dither) {
  // Straight up to 0.7, then a shoulder that keeps highlights from clipping; the eye's gamma of 2.2.
  const float knee = 0.7F;
  const float soft =
      light <= knee ? light : knee + (1.0F - knee) * (1.0F - std::exp(-(light - knee) / (1.0F - knee)));
  const float encoded = std::pow(std::clamp(soft, 0.0F, 1.0F), 1.0F / 2.2F);
  return static_cast<std::uint8_t>(std::min(255.0F, 255.0F * encoded + dither));
}

void draw_row(const Tracer& tracer, Picture& picture, int y) {
  for (int x = 0; x < picture.width; ++x) {
    const Vec3f light = tracer.pixel(x, y);
    const float dither = Samples(x, y).pair(3, 0).x();
    for (int k = 0; k < 3; ++k) picture.pixel(x, y)[k] = encode(light[k], dither);
  }
}

}  // namespace

Picture draw(const Drawing& drawing, const Camera& camera, const scene::ViewOptions& view, int threads) {
  const Tracer tracer(drawing, camera, view);
  Picture picture(view.width, view.height);
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int y = next++; y < picture.height; y = next++) draw_row(tracer, picture, y);
  };
  std::vector<std::jthread> helpers;
  for (int k = 1; k < threads; ++k) helpers.emplace_back(work);
  work();
  helpers.clear();
  return picture;
}

}  // namespace tendril::runner
