#include <tendril/base/error.h>
#include <tendril/curve/manipulate.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril {
namespace {

void check(const PolygonPair& pair, std::size_t i) {
  if (pair.p.size() != pair.q.size() || pair.p.size() < 2)
    throw InvalidInput("polygon pair",
                       std::to_string(pair.p.size()) + " and " + std::to_string(pair.q.size()) + " points",
                       "two polygons of the same size, at least 2");
  if (i >= pair.p.size())
    throw InvalidInput("index", std::to_string(i), "less than " + std::to_string(pair.p.size()));
}

/// Tangents of the nodes in [first, last], from a window one node wider on both sides.
struct Window {
  PolygonTangents tangents;
  std::size_t begin;
  const Vec3& t(std::size_t i) const { return tangents.t[i - begin]; }
  FrameStatus status(std::size_t i) const { return tangents.status[i - begin]; }
};

Window window(const PolygonPair& pair, std::size_t first, std::size_t last) {
  const std::size_t begin = first - std::min<std::size_t>(first, 1);
  const std::size_t end = std::min(pair.p.size(), last + 2);
  return {polygon_tangents(Points(pair.p).subspan(begin, end - begin)), begin};
}

}  // namespace

FrameStatus move_point(PolygonPair& pair, std::size_t i, const Vec3& to) {
  check(pair, i);
  if (!is_finite(to)) throw InvalidInput("point", "not finite", "three finite numbers");
  const std::size_t first = i - std::min<std::size_t>(i, 1);
  const std::size_t last = std::min(pair.p.size() - 1, i + 1);
  const Window before = window(pair, first, last);
  std::vector<Vec3> offset;
  for (std::size_t k = first; k <= last; ++k) offset.push_back(pair.q[k] - pair.p[k]);
  pair.p[i] = to;
  const Window after = window(pair, first, last);

  FrameStatus status = FrameStatus::ok;
  for (std::size_t k = first; k <= last; ++k) {
    const bool sound = before.status(k) == FrameStatus::ok && after.status(k) == FrameStatus::ok;
    if (!sound && status == FrameStatus::ok)
      status = after.status(k) != FrameStatus::ok ? after.status(k) : before.status(k);
    const Vec3& v = offset[k - first];
    pair.q[k] = pair.p[k] + (sound ? rotate_smallest(before.t(k), after.t(k), v) : v);
  }
  return status;
}

FrameStatus twist_point(PolygonPair& pair, std::size_t i, double angle) {
  check(pair, i);
  if (!std::isfinite(angle)) throw InvalidInput("angle", "not finite", "a finite number of radians");
  const Window at = window(pair, i, i);
  pair.q[i] = pair.p[i] + rotate_about(at.t(i), angle, pair.q[i] - pair.p[i]);
  return at.status(i);
}

}  // namespace tendril
