#include "exact/surface/inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tendril::exact {

namespace {

/// The turn a, b, x as seen along z. Moved by (e, e^2), x adds e (a_y - b_y) + e^2 (b_x - a_x) to the turn's
/// determinant.
int turn_of_moved(const Predicates& signs, const Vec3& a, const Vec3& b, const Vec3& x) {
  if (const int turn = signs.turn(2, a, b, x)) return turn;
  if (const int first = compare(a.y(), b.y())) return first;
  return compare(b.x(), a.x());
}

}  // namespace

Closure closure_of(std::span<const std::uint32_t> corners) {
  struct Edge {
    std::uint32_t low, high;
    int way;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[i + k], b = corners[i + (k + 1) % 3];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  std::sort(edges.begin(), edges.end());
  Closure closure = Closure::oriented;
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t begin = i;
    int way = 0;
    for (; i < edges.size() && edges[i].low == edges[begin].low && edges[i].high == edges[begin].high; ++i)
      way += edges[i].way;
    if ((i - begin) % 2 != 0) return Closure::open;
    if (way != 0) closure = Closure::even;
  }
  return closure;
}

std::vector<std::uint32_t> with_coincident_as_one(Points points, std::span<const std::uint32_t> corners) {
  std::vector<std::uint32_t> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int c = compare(points[a], points[b]);
    return c != 0 ? c < 0 : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && compare(points[order[i - 1]], points[order[i]]) == 0;
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  std::vector<std::uint32_t> out;
  for (const std::uint32_t c : corners) out.push_back(first[c]);
  return out;
}

double solid_angle(const Triangle& t, const Vec3& x) {
  const Vec3 a = (t[0] - x).stableNormalized(), b = (t[1] - x).stableNormalized(),
             c = (t[2] - x).stableNormalized();
  return 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
}

int crossing_above(const Predicates& signs, const Triangle& t, const Vec3& x) {
  const int turn = turn_of_moved(signs, t[0], t[1], x);
  if (turn == 0 || turn_of_moved(signs, t[1], t[2], x) != turn || turn_of_moved(signs, t[2], t[0], x) != turn)
    return 0;
  return signs.side(t[0], t[1], t[2], x) == -turn ? turn : 0;
}

}  // namespace tendril::exact
