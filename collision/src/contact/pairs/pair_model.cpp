#include "pair_model.h"

#include <tendril/collision/box_tree.h>

#include <algorithm>
#include <cmath>

namespace tendril::contact {
namespace {

double thinnest(const std::vector<ContactRod>& rods) {
  double result = thickest(rods);
  for (const ContactRod& rod : rods) result = std::min(result, rod.radius);
  return result;
}

/// With h^2 <= (r + r') range / 8 the margin is at most range / 32 (and half as much again where edges are
/// stretched). What comes half the range near has some six points within it on either rod, so that the sum
/// hardly feels where they are.
RodLines::Apart apart_for(const std::vector<ContactRod>& rods, double range) {
  return
      [least = thinnest(rods), range](double radius) { return std::sqrt(0.125 * (least + radius) * range); };
}

/// Per edge: the square of the way between points.
std::vector<double> squares(const RodLines& lines) {
  std::vector<double> result;
  for (const LineEdge& edge : lines.edges) result.push_back(lines.widest(edge) * lines.widest(edge));
  return result;
}

/// Between two segments: the squared distance is convex, so that going to and fro between the nearest points
/// on lines, clamped, ends at the least; one of the ends is part of it where the lines' own nearest points
/// are not on both.
double distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto to_segment = [](const Vec3& x, const Vec3& from, const Vec3& to) {
    const Vec3 along = to - from;
    const double square = along.squaredNorm();
    const double at = square > 0.0 ? std::clamp((x - from).dot(along) / square, 0.0, 1.0) : 0.0;
    return (x - from - at * along).norm();
  };
  double least = std::min(std::min(to_segment(a, c, d), to_segment(b, c, d)),
                          std::min(to_segment(c, a, b), to_segment(d, a, b)));
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  if (!(det > 1e-12 * uu * vv)) return least;
  const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
  if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) least = std::min(least, (w + s * u - t * v).norm());
  return least;
}

Vec3 mean_way(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < to.size(); ++i) sum += to[i] - from[i];
  return sum / static_cast<double>(to.size());
}

}  // namespace

PairModel::PairModel(std::vector<ContactRod> rods, const std::vector<RodJoint>& joints, const Law& how)
    : law(checked(how)),
      lines(rods, apart_for(rods, how.range)),
      widest2(squares(lines)),
      // The margin is at most range / 20, see above.
      exclusions(lines, joints, 2.0 * thickest(rods) + 1.05 * how.range,
                 [this](std::uint32_t e, std::uint32_t f) { return meets(e, f); }) {}

double PairModel::weight(const PointPair& at) const {
  const LinePoint &x = lines.points[at.first], &y = lines.points[at.second];
  return x.weight * y.weight / std::sqrt(2.0 * thick(x.edge, y.edge) * law.range);
}

std::shared_ptr<const NeighbourList> PairModel::search(std::vector<Vec3> p, double skin) const {
  auto result = std::make_shared<NeighbourList>();
  // What is not finite ends the step by its own name.
  if (!all_finite(p)) return result;
  std::vector<collision::Box> boxes;
  boxes.reserve(lines.edges.size());
  for (std::uint32_t e = 0; e < lines.edges.size(); ++e) {
    const std::uint32_t node = lines.edges[e].global;
    const Vec3 far = Vec3::Constant(0.5 * (thick(e, e) + 2.0 * margin(e, e) + law.range + skin));
    boxes.push_back({p[node].cwiseMin(p[node + 1]) - far, p[node].cwiseMax(p[node + 1]) + far});
  }
  const collision::BoxTree tree(boxes);
  tree.pairs(tree, [&](std::size_t a, std::size_t b) {
    const auto e = static_cast<std::uint32_t>(a), f = static_cast<std::uint32_t>(b);
    if (e < f && slack(p, e, f) <= skin) result->pairs.emplace_back(e, f);
  });
  std::sort(result->pairs.begin(), result->pairs.end());
  result->p = std::move(p);
  result->skin = skin;
  return result;
}

double PairModel::slack(const std::vector<Vec3>& p, std::uint32_t e, std::uint32_t f) const {
  const Excluded* excluded = exclusions.between(e, f);
  const std::uint32_t a = lines.edges[e].global, c = lines.edges[f].global;
  const double apart = distance(p[a], p[a + 1], p[c], p[c + 1]) - meets(e, f);
  // Edges that share a node are near each other for ever: what counts is points that may touch.
  if (excluded == nullptr || apart > 0.0) return apart;
  const LineEdge &first = lines.edges[e], &second = lines.edges[f];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first.first; i < first.end; ++i)
    for (std::size_t j = second.first; j < second.end; ++j)
      if (!exclusions.excludes(*excluded, i - first.first, j - second.first, second.end - second.first))
        least = std::min(least, (point(p, i) - point(p, j)).squaredNorm());
  return std::sqrt(least) - meets(e, f);
}

bool PairModel::reachable(const std::vector<Vec3>& before, const PointPair& now) const {
  const Vec3 from = point(before, now.first) - point(before, now.second), way = now.apart - from;
  const double square = way.squaredNorm();
  const double at = square > 0.0 ? std::clamp(-from.dot(way) / square, 0.0, 1.0) : 0.0;
  const std::uint32_t e = lines.points[now.first].edge, f = lines.points[now.second].edge;
  return (from + at * way).norm() > thick(e, f) + margin(e, f);
}

std::vector<double> moved(const RodLines& lines, const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const Vec3 mean = mean_way(from, to);
  std::vector<double> result;
  result.reserve(lines.edges.size());
  for (const LineEdge& edge : lines.edges) {
    const Vec3 a = to[edge.global] - from[edge.global] - mean;
    const Vec3 b = to[edge.global + 1] - from[edge.global + 1] - mean;
    result.push_back(std::sqrt(std::max(a.squaredNorm(), b.squaredNorm())));
  }
  return result;
}

double most_moved(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  const Vec3 mean = mean_way(from, to);
  double most = 0.0;
  for (std::size_t i = 0; i < to.size(); ++i) most = std::max(most, (to[i] - from[i] - mean).squaredNorm());
  return std::sqrt(most);
}

}  // namespace tendril::contact
