#include "gltf/skin.h"

#include "gltf/fit.h"

#include <algorithm>

namespace tendril::runner {
namespace {

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

std::vector<double> errors_of(const Film& film, const Skin& skin) {
  std::vector<double> out;
  for (std::size_t m = 0; m < film.moments().size(); ++m) out.push_back(error_at(film, m, skin));
  return out;
}

/// Adds the worst of the moments that are too far off and not looked at yet; whether there are any.
bool look_at_worst(const std::vector<double>& errors, double tolerance, std::vector<std::size_t>& moments) {
  constexpr std::size_t kMore = 4;
  std::vector<std::pair<double, std::size_t>> worst;
  for (std::size_t m = 0; m < errors.size(); ++m)
    if (errors[m] > tolerance && std::find(moments.begin(), moments.end(), m) == moments.end())
      worst.emplace_back(errors[m], m);
  std::sort(worst.rbegin(), worst.rend());
  for (std::size_t k = 0; k < std::min(kMore, worst.size()); ++k) moments.push_back(worst[k].second);
  return !worst.empty();
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
  constexpr double kRoom = 0.98;  // of the tolerance is used at the moments looked at, less each time
  const double size = bind::bounding_diagonal(film.mesh().points);
  const double unit = size > 0.0 ? size : 1.0, tolerance = options.tolerance * unit;
  const std::size_t max_joints = std::max(options.max_joints, 2 * film.rest().size() + 1);
  std::vector<std::size_t> moments = spread_moments(film.moments().size(), kMoments);
  Skin best;
  double room = tolerance;
  for (std::size_t round = 0; round < kRounds; ++round) {
    Skin skin = SkinFit(film, moments).skin(room *= kRoom, max_joints);
    const bool all_that_joints_do = !skin.reached;
    const std::vector<double> errors = errors_of(film, skin);
    skin.error = *std::max_element(errors.begin(), errors.end()) / unit;
    skin.reached = skin.error <= options.tolerance;
    if (round == 0 || skin.error < best.error) best = std::move(skin);
    if (best.reached || all_that_joints_do || !look_at_worst(errors, tolerance, moments)) break;
  }
  return best;
}

}  // namespace tendril::runner
