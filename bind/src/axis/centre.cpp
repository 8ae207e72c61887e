#include "centre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::axis {
namespace {

constexpr int kRounds = 3, kMiddleRounds = 5;
constexpr double kAside = 0.25;            ///< sides of which one is nearer by this share are left alone
constexpr double kThick = 3.0;             ///< a limb's width, in clearances nearby
constexpr double kThrough = 1e-6;          ///< beyond a surface just met
constexpr std::size_t kNear = 8;           ///< points either way
constexpr std::size_t kRays = 16;          ///< round a point, to see a limb's section
constexpr std::size_t kFarthestApart = 7;  ///< from ray to ray: most sections are given up after a few
constexpr double kSeen = 2.5;              ///< the longest ray of a limb's section, in the shortest
constexpr double kRound = 1.15;            ///< the longest radius of a round section, in the shortest
constexpr double kNotRound = 1.3;          ///< of one that is not
constexpr double kShort = 0.05;            ///< radii that an end may be short of where it should be

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

using Section = std::array<Vec3, kRays>;  ///< corners, from a point within

double longest_in_shortest(const Section& section, const Vec3& p) {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (const Vec3& corner : section) {
    shortest = std::min(shortest, (corner - p).norm());
    longest = std::max(longest, (corner - p).norm());
  }
  return longest / shortest;
}

/// What is seen of the surface from p across t; nothing where one way is much farther than another, as where
/// a limb leaves a body.
std::optional<Section> section_at(const Surface& surface, const Vec3& p, const Vec3& t) {
  if (!(t.squaredNorm() > 0.5)) return std::nullopt;  // points in one place have no direction
  const Vec3 x = t.unitOrthogonal(), y = t.cross(x);
  Section section;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  for (std::size_t k = 0; k < kRays; ++k) {
    const std::size_t i = kFarthestApart * k % kRays;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kRays);
    const Vec3 d = std::cos(angle) * x + std::sin(angle) * y;
    const std::optional<double> hit = surface.first_hit(p, d);
    if (!hit) return std::nullopt;
    shortest = std::min(shortest, *hit);
    longest = std::max(longest, *hit);
    if (!(longest <= kSeen * shortest)) return std::nullopt;
    section[i] = *hit * d;
  }
  return section;
}

double mean_radius(const Section& section) {
  double sum = 0.0;
  for (const Vec3& corner : section) sum += corner.norm();
  return sum / static_cast<double>(kRays);
}

/// Of the polygon, from where its corners are counted.
Vec3 centroid(const Section& section, const Vec3& t) {
  Vec3 moment = Vec3::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Vec3 &a = section[i], &b = section[(i + 1) % kRays];
    const double part = t.dot(a.cross(b));
    moment += part * (a + b) / 3.0;
    area += part;
  }
  return moment / area;
}

/// From p to the section's centroid; all the way where the section is round, less where it is less so, and
/// not at all from kNotRound on, where a section's middle jumps from point to point.
Vec3 to_round_middle(const Surface& surface, const Vec3& p, const Vec3& t) {
  const std::optional<Section> section = section_at(surface, p, t);
  if (!section) return Vec3::Zero();
  const Vec3 middle = centroid(*section, t);
  const double ratio = longest_in_shortest(*section, middle);
  return std::clamp((kNotRound - ratio) / (kNotRound - kRound), 0.0, 1.0) * middle;
}

/// The means of the moves over a clearance either way, by the biweight 1 - x^2 squared: what varies faster
/// along the line than the limb is thick is not the limb's.
std::vector<Vec3> smoothed(const std::vector<Vec3>& moves, const std::vector<double>& clearance,
                           double step) {
  std::vector<Vec3> out(moves.size(), Vec3::Zero());
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto all = static_cast<double>(moves.size());
    const auto reach = static_cast<std::size_t>(std::clamp(clearance[k] / step, 2.0, all));
    double weights = 0.0;
    for (std::size_t i = k - std::min(k, reach); i < std::min(k + reach + 1, moves.size()); ++i) {
      const double x = (static_cast<double>(i) - static_cast<double>(k)) / static_cast<double>(reach + 1);
      const double weight = (1.0 - x * x) * (1.0 - x * x);
      out[k] += weight * moves[i];
      weights += weight;
    }
    out[k] /= weights;
  }
  return out;
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

/// Points far nearer to one side than to the other.
void put_half_way(Line& line, const Surface& surface, const Stays& stays) {
  const std::vector<double> clearance = clearances(line, surface);
  std::vector<Vec3> moves(line.size(), Vec3::Zero());
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec3 t = tangent(line, k), away = surface.nearest(line[k]) - line[k];
    const Vec3 across = away - away.dot(t) * t;
    if (!(across.norm() > 0.3 * away.norm())) continue;  // an end of a limb is nearest
    const Vec3 d = across.normalized();
    moves[k] = half_way(surface, line[k], d, kThick * largest_near(clearance, k)) * d;
  }
  moves = smoothed(moves);
  if (stays.last) moves.back().setZero();
  for (std::size_t k = 0; k < line.size(); ++k) line[k] += moves[k];
}

/// Points of round limbs.
/// \param round  which may be; those that are not are taken out
void put_in_middle(Line& line, const Surface& surface, const Stays& stays, std::vector<char>& round) {
  const std::vector<double> clearance = clearances(line, surface);
  std::vector<Vec3> moves(line.size(), Vec3::Zero());
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (round[k] && clearance[k] > 0.0) moves[k] = to_round_middle(surface, line[k], tangent(line, k));
    round[k] = moves[k] != Vec3::Zero();
  }
  const double step = (line[1] - line[0]).norm();
  moves = smoothed(moves, clearance, std::max(step, std::numeric_limits<double>::min()));
  if (stays.first) moves.front().setZero();
  if (stays.last) moves.back().setZero();
  for (std::size_t k = 0; k < line.size(); ++k) line[k] += moves[k];
}

}  // namespace

Line centred(const Line& line, const Surface& surface, const Stays& stays) {
  Line out = line;
  for (int round = 0; round < kRounds; ++round) put_half_way(out, surface, stays);
  std::vector<char> round(out.size(), 1);
  for (int k = 0; k < kMiddleRounds; ++k) put_in_middle(out, surface, stays, round);
  return out;
}

double extend_end(Line& line, const Surface& surface) {
  const Vec3 t = tangent(line, line.size() - 1), end = line.back();
  if (!surface.holds(end)) return 0.0;
  const std::optional<Section> section = section_at(surface, end, t);
  const std::optional<double> left = surface.first_hit(end, t);
  if (!section || !left) return 0.0;
  const double radius = mean_radius(*section), more = *left - radius;
  if (!(more > kShort * radius)) return 0.0;
  const std::optional<Section> there = section_at(surface, end + more * t, t);
  if (!there || std::abs(mean_radius(*there) - radius) > 0.5 * radius) return 0.0;
  line.push_back(end + more * t);
  return more;
}

std::vector<double> half_widths(const Line& line, const Surface& surface) {
  const std::vector<double> clearance = clearances(line, surface);
  std::vector<double> out;
  for (std::size_t k = 0; k < line.size(); ++k)
    out.push_back(std::max({clearance[k], 0.5 * largest_near(clearance, k), 1e-6}));
  return out;
}

}  // namespace tendril::axis
