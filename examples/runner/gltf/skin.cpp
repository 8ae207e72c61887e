#include "gltf/skin.h"

#include "gltf/fit.h"

#include <algorithm>

namespace tendril::runner {
namespace {

/// The worst of all moments.
struct Worst {
  double error = 0.0;
  std::size_t moment = 0;
};

double error_at(const Film& film, std::size_t moment, const Skin& skin) {
  const std::vector<CurvePair> posed = film.posed(moment);
  std::vector<JointMotion> motions;
  for (const SkinJoint& joint : skin.joints) motions.push_back(motion_of(joint, film.rest(), posed));
  const std::vector<Vec3> exact = film.points(moment);
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    Vec3 sum = -exact[i];
    const Influences& mine = skin.influences[i];
    for (std::size_t k = 0; k < 4; ++k)
      if (mine.weight[k] > 0.0) sum += mine.weight[k] * motions[mine.joint[k]](film.mesh().points[i]);
    worst = std::max(worst, sum.norm());
  }
  return worst;
}

Worst worst_of(const Film& film, const Skin& skin) {
  Worst out;
  for (std::size_t m = 0; m < film.moments().size(); ++m) {
    const double error = error_at(film, m, skin);
    if (error > out.error) out = {error, m};
  }
  return out;
}

std::vector<std::size_t> spread_moments(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < std::min(count, wanted); ++k)
    out.push_back(wanted > 1 && count > wanted ? k * (count - 1) / (wanted - 1) : k);
  return out;
}

}  // namespace

JointMotion motion_of(const SkinJoint& joint, std::span<const CurvePair> rest,
                      std::span<const CurvePair> posed) {
  if (joint.pair == SkinJoint::kStill) return {};
  const CurveFrame a = rest[joint.pair].frame(joint.t), b = posed[joint.pair].frame(joint.t);
  Mat3 from, to;
  from << a.frame.x, a.frame.y, a.frame.z;
  to << b.frame.x, b.frame.y, b.frame.z;
  return {to * from.transpose(), a.origin, b.origin};
}

void Influences::add(std::size_t to, double part) {
  const auto free = std::find(weight.begin(), weight.end(), 0.0);
  if (free == weight.end() || !(part > 0.0)) return;
  *free = part;
  joint[static_cast<std::size_t>(free - weight.begin())] = static_cast<std::uint16_t>(to);
}

Skin fit_skin(const Film& film, const SkinOptions& options) {
  constexpr std::size_t kMoments = 16, kRounds = 8;
  constexpr double kRoom = 0.97;  // of the tolerance, at the moments that are looked at
  const double size = bind::bounding_diagonal(film.mesh().points);
  const double tolerance = options.tolerance * size;
  std::vector<std::size_t> moments = spread_moments(film.moments().size(), kMoments);
  Skin skin;
  for (std::size_t round = 0; round < kRounds; ++round) {
    const SkinFit fit(film, moments);
    skin = fit.skin(kRoom * tolerance, std::max(options.max_joints, 2 * film.rest().size() + 1));
    const Worst worst = worst_of(film, skin);
    skin.error = size > 0.0 ? worst.error / size : 0.0;
    skin.reached = skin.error <= options.tolerance;
    if (skin.reached || std::find(moments.begin(), moments.end(), worst.moment) != moments.end()) break;
    moments.push_back(worst.moment);
  }
  return skin;
}

}  // namespace tendril::runner
