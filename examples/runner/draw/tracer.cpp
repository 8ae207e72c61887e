#include "draw/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tendril::runner {
namespace {

constexpr float kEpsilon = 2e-4F;      // of the size of what is seen: lifts secondary rays off their surface
constexpr float kSunRadius = 0.09F;    // tangent of the sun's half angle: how soft shadows are
constexpr float kSkyReach = 0.7F;      // of the size: what is farther away does not darken
constexpr float kBounce = 0.22F;       // light that comes from a neighbouring surface instead of the sky
constexpr float kGroundLight = 0.55F;  // and from the ground
constexpr float kGroundSize = 4.0F;    // of the size: beyond, the ground is wall

struct Axes {
  Vec3f x, y;
};

Axes across(const Vec3f& z) {
  const Vec3f other = std::abs(z.x()) < 0.7F ? Vec3f::UnitX() : Vec3f::UnitY();
  const Vec3f x = z.cross(other).normalized();
  return {x, z.cross(x)};
}

}  // namespace

Tracer::Tracer(const Drawing& drawing, const Camera& camera)
    : solid_(drawing.mesh, drawing.solid, camera.centre, camera.size),
      over_(nullptr, drawing.over, camera.centre, camera.size),
      has_over_(!drawing.over.empty()),
      eye_(((camera.eye - camera.centre) / camera.size).cast<float>()),
      right_((camera.right * camera.tan_x).cast<float>()),
      up_((camera.up * camera.tan_y).cast<float>()),
      forward_(camera.forward.cast<float>()),
      ground_up_(camera.ground_up.cast<float>()),
      ground_(static_cast<float>((camera.ground - camera.centre.dot(camera.ground_up)) / camera.size)),
      sun_((0.9 * camera.ground_up - 0.45 * camera.right - 0.5 * camera.forward).normalized().cast<float>()),
      sun_x_(across(sun_).x),
      sun_y_(across(sun_).y) {}

Seen Tracer::describe(const Vec3f& direction, float height, const std::optional<Hit>& hit) const {
  Seen out;
  out.height = height;
  out.direction = direction;
  if (hit) {
    out.kind = Seen::Kind::surface;
    out.distance = hit->distance;
    out.normal = hit->normal;
    out.color = hit->color;
    out.at = eye_ + hit->distance * direction + kEpsilon * hit->flat;
    return out;
  }
  const float down = direction.dot(ground_up_), above = eye_.dot(ground_up_) - ground_;
  const float distance = down < 0.0F && above > 0.0F ? above / -down : -1.0F;
  const Vec3f at = eye_ + distance * direction + kEpsilon * ground_up_;
  if (distance > 0.0F && at.norm() <= kGroundSize) {
    out.kind = Seen::Kind::ground;
    out.distance = distance;
    out.normal = ground_up_;
    out.at = at;
  }
  return out;
}

void Tracer::look(std::span<const Eigen::Vector2f> places, std::span<Seen> out) const {
  std::array<Vec3f, kBundle> directions;
  std::array<std::optional<Hit>, kBundle> hits;
  const std::size_t count = places.size();
  for (std::size_t k = 0; k < count; ++k)
    directions[k] = (forward_ + places[k].x() * right_ + places[k].y() * up_).normalized();
  const std::span<const Vec3f> towards(directions.data(), count);
  solid_.nearest(eye_, towards, hits);
  for (std::size_t k = 0; k < count; ++k) out[k] = describe(directions[k], places[k].y(), hits[k]);
  if (!has_over_) return;
  over_.nearest(eye_, towards, hits);
  for (std::size_t k = 0; k < count; ++k) {
    if (!hits[k]) continue;
    out[k].strand = true;
    const float facing = 0.35F + 0.65F * std::max(0.0F, -hits[k]->normal.dot(directions[k]));
    out[k].bright = hits[k]->color * (1.3F * facing);
    out[k].strand_hidden = out[k].kind == Seen::Kind::surface && out[k].distance < hits[k]->distance;
  }
}

Vec3f Tracer::to_sun(const Eigen::Vector2f& sample) const {
  const float radius = kSunRadius * std::sqrt(sample.x());
  const float angle = 2.0F * std::numbers::pi_v<float> * sample.y();
  return (sun_ + radius * (std::cos(angle) * sun_x_ + std::sin(angle) * sun_y_)).normalized();
}

void Tracer::sunlit(std::span<const Seen> seen, std::span<const Eigen::Vector2f> samples,
                    std::span<std::uint8_t> out) const {
  std::array<Vec3f, kBundle> origins, directions;
  std::array<std::size_t, kBundle> of;
  std::size_t count = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    out[k] = 0;
    if (seen[k].kind == Seen::Kind::wall || !(seen[k].normal.dot(sun_) > 0.0F)) continue;
    origins[count] = seen[k].at;
    directions[count] = to_sun(samples[k]);
    of[count++] = k;
  }
  if (count == 0) return;
  const std::uint32_t dark = solid_.blocked({origins.data(), count}, {directions.data(), count}, 1e30F);
  for (std::size_t j = 0; j < count; ++j) out[of[j]] = (dark >> j & 1U) == 0 ? 1 : 0;
}

float Tracer::skylight(const Seen& seen, const Samples& samples, int count) const {
  if (seen.kind == Seen::Kind::wall) return 1.0F;
  const Axes axes = across(seen.normal);
  std::array<Vec3f, kBundle> origins, directions;
  origins.fill(seen.at);
  float sum = 0.0F;
  for (int first = 0; first < count; first += static_cast<int>(kBundle)) {
    const std::size_t rays = std::min(kBundle, static_cast<std::size_t>(count - first));
    for (std::size_t k = 0; k < rays; ++k) {
      const Eigen::Vector2f u = samples.pair(2, first + static_cast<int>(k));
      const float radius = std::sqrt(u.x()), angle = 2.0F * std::numbers::pi_v<float> * u.y();
      directions[k] = radius * (std::cos(angle) * axes.x + std::sin(angle) * axes.y) +
                      std::sqrt(std::max(0.0F, 1.0F - u.x())) * seen.normal;
    }
    const std::uint32_t dark = solid_.blocked({origins.data(), rays}, {directions.data(), rays}, kSkyReach);
    for (std::size_t k = 0; k < rays; ++k) {
      if ((dark >> k & 1U) != 0) {
        sum += kBounce;
      } else {
        sum += directions[k].dot(ground_up_) < 0.0F ? kGroundLight : 1.0F;
      }
    }
  }
  return sum / static_cast<float>(count);
}

Vec3f Tracer::shade(const Seen& seen, float sun, float sky) const {
  Vec3f light;
  if (seen.kind == Seen::Kind::surface) {
    const Vec3f sun_color(1.50F, 1.40F, 1.26F), sky_color(0.56F, 0.61F, 0.68F);
    const float direct = std::max(0.0F, seen.normal.dot(sun_)) * sun;
    const Vec3f half = (sun_ - seen.direction).normalized();
    const float gloss =
        0.06F * std::pow(std::max(0.0F, half.dot(seen.normal)), 24.0F) * (direct > 0.0F ? sun : 0.0F);
    light = Vec3f(seen.color.cwiseProduct(direct * sun_color + sky * sky_color)) + Vec3f::Constant(gloss);
  } else {
    // A pale wall, and the ground that takes its colour and darkens only where light is kept from it.
    const float blend = 0.5F * (seen.height + 1.0F);
    light = (1.0F - blend) * Vec3f(0.86F, 0.85F, 0.83F) + blend * Vec3f(0.80F, 0.84F, 0.88F);
    if (seen.kind == Seen::Kind::ground) light *= (0.58F + 0.42F * sun) * (0.35F + 0.65F * sky);
  }
  if (!seen.strand) return light;
  return seen.strand_hidden ? Vec3f(0.45F * light + 0.55F * seen.bright) : seen.bright;
}

}  // namespace tendril::runner
