#include "centre.h"

#include <algorithm>

namespace tendril::axis {
namespace {

constexpr int kRounds = 3;
constexpr double kAside = 0.25;    ///< sides of which one is nearer by this share are left alone
constexpr double kThick = 3.0;     ///< a limb's width, in clearances nearby
constexpr double kThrough = 1e-6;  ///< beyond a surface just met
constexpr std::size_t kNear = 8;   ///< points either way

Vec3 tangent(const Line& line, std::size_t k) {
  const std::size_t from = k < 3 ? 0 : k - 3, to = std::min(k + 3, line.size() - 1);
  return (line[to] - line[from]).stableNormalized();
}

/// 0 outside.
std::vector<double> clearances(const Line& line, const Surface& surface) {
  std::vector<double> out;
  for (const Vec3& p : line) out.push_back(surface.holds(p) ? surface.distance(p) : 0.0);
  return out;
}

/// The largest of the values within kNear of the k-th.
double largest_near(const std::vector<double>& values, std::size_t k) {
  const std::size_t from = k < kNear ? 0 : k - kNear, to = std::min(k + kNear + 1, values.size());
  return *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(from),
                           values.begin() + static_cast<std::ptrdiff_t>(to));
}

/// How far to go along d from p to be half way between the sides; 0 where that cannot be said.
double half_way(const Surface& surface, const Vec3& p, const Vec3& d, double most) {
  const std::optional<double> near = surface.first_hit(p, d);
  if (!near) return 0.0;
  if (!surface.holds(p)) {
    const Vec3 inside = p + (*near + kThrough) * d;
    const std::optional<double> far = surface.first_hit(inside, d);
    return far && surface.holds(inside) ? *near + kThrough + 0.5 * *far : 0.0;
  }
  const std::optional<double> far = surface.first_hit(p, -d);
  if (!far || *near > kAside * *far || *near + *far > most) return 0.0;
  return 0.5 * (*near - *far);
}

/// The moves of a round, each the mean of five.
std::vector<Vec3> smoothed(const std::vector<Vec3>& moves) {
  std::vector<Vec3> out(moves.size(), Vec3::Zero());
  for (std::size_t k = 1; k < moves.size(); ++k) {
    const std::size_t from = k < 2 ? 0 : k - 2, to = std::min(k + 2, moves.size() - 1);
    for (std::size_t i = from; i <= to; ++i) out[k] += moves[i] / static_cast<double>(to - from + 1);
  }
  return out;
}

}  // namespace

Line centred(const Line& line, const Surface& surface) {
  Line out = line;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> clearance = clearances(out, surface);
    std::vector<Vec3> moves(out.size(), Vec3::Zero());
    for (std::size_t k = 1; k < out.size(); ++k) {
      const Vec3 t = tangent(out, k), away = surface.nearest(out[k]) - out[k];
      const Vec3 across = away - away.dot(t) * t;
      if (!(across.norm() > 0.3 * away.norm())) continue;  // an end of a limb is nearest
      const Vec3 d = across.normalized();
      moves[k] = half_way(surface, out[k], d, kThick * largest_near(clearance, k)) * d;
    }
    moves = smoothed(moves);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += moves[k];
  }
  return out;
}

std::vector<double> half_widths(const Line& line, const Surface& surface) {
  const std::vector<double> clearance = clearances(line, surface);
  std::vector<double> out;
  for (std::size_t k = 0; k < line.size(); ++k)
    out.push_back(std::max({clearance[k], 0.5 * largest_near(clearance, k), 1e-6}));
  return out;
}

}  // namespace tendril::axis
