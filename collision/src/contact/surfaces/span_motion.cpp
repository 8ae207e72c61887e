#include "span_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril::contact {
namespace {

using Column = std::array<Vec3, kMaxDegree + 1>;

/// Control points of a span, of its derivative, and of n.
struct Controls {
  Column at, rate, offset;
};

template <class Place>
Controls controls(const UsedSpan& span, const CurvePair& pair, const Place& place) {
  const Points u = pair.primary().control_points(), v = pair.orientation().control_points();
  Controls out;
  for (std::size_t i = 0; i < span.count; ++i) {
    out.at[i] = place(u[span.first + i]);
    out.offset[i] = place(v[span.first + i]) - out.at[i];
    if (i > 0) out.rate[i - 1] = span.rise[i - 1] * (out.at[i] - out.at[i - 1]);
  }
  return out;
}

double widest(const Column& a, const Column& b, std::size_t count) {
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, (a[i] - b[i]).squaredNorm());
  return std::sqrt(most);
}

/// Least component along a direction.
double least_along(const Column& a, std::size_t count, const Vec3& way) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) least = std::min(least, a[i].dot(way));
  return least;
}

Vec3 mean(const Column& a, std::size_t count) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += a[i];
  return sum;
}

}  // namespace

UsedSpan::UsedSpan(std::uint32_t of, const KnotVector& knots, int span)
    : pair(of),
      first(static_cast<std::uint32_t>(span - knots.degree())),
      count(static_cast<std::uint32_t>(knots.degree() + 1)),
      rise{} {
  const auto p = static_cast<std::size_t>(knots.degree());
  for (std::size_t i = 0; i < p; ++i)
    rise[i] = static_cast<double>(p) / (knots.knots()[first + i + p + 1] - knots.knots()[first + i + 1]);
}

/// c' lies in the hull of its control points and so goes at least as far along their mean as the least of
/// them does; n likewise along e, the part of its mean across that of c'. Of n' = n - (n . Z) Z along e
/// that leaves at least min n . e - |n| max |Z . e|.
SpanShape shape_of(const UsedSpan& span, const CurvePair& pair) {
  const Controls c = controls(span, pair, [](const Vec3& x) { return x; });
  const std::size_t rates = span.count - 1;
  const Vec3 along = mean(c.rate, rates).stableNormalized();
  const double speed = least_along(c.rate, rates, along);
  const Vec3 offset = mean(c.offset, span.count);
  const Vec3 across = (offset - offset.dot(along) * along).stableNormalized();
  double aside = 0.0, longest = 0.0;
  for (std::size_t i = 0; i < rates; ++i) aside = std::max(aside, std::abs(c.rate[i].dot(across)));
  for (std::size_t i = 0; i < span.count; ++i) longest = std::max(longest, c.offset[i].norm());
  if (!(speed > 0.0)) return {0.0, 0.0, longest};
  return {speed, least_along(c.offset, span.count, across) - longest * aside / speed, longest};
}

double motion(const UsedSpan& span, const SpanShape& shape, const PosedFrom& before, const PosedFrom& now) {
  if (!(shape.least_speed > 0.0 && shape.least_across > 0.0)) return std::numeric_limits<double>::infinity();
  const Controls a = controls(span, before.pair, [&](const Vec3& x) { return before.solid.to_local(x); });
  const Controls b = controls(span, now.pair, [&](const Vec3& x) { return now.solid.to_local(x); });
  const double turn = 2.0 * widest(a.rate, b.rate, span.count - 1) / shape.least_speed;
  const double about =
      2.0 * (2.0 * widest(a.offset, b.offset, span.count) + turn * shape.most_offset) / shape.least_across;
  // Rounding of what is computed here and of vertices is far below this share of the sizes.
  double size = span.reach;
  for (std::size_t i = 0; i < span.count; ++i) size = std::max({size, a.at[i].norm(), b.at[i].norm()});
  return (widest(a.at, b.at, span.count) + span.reach * (turn + about)) * (1.0 + 1e-9) + 1e-12 * size;
}

Placement going_with(const UsedSpan& span, const CurvePair& pair) {
  const Controls c = controls(span, pair, [](const Vec3& x) { return x; });
  Placement result;
  result.position = mean(c.at, span.count) / static_cast<double>(span.count);
  const Vec3 z = mean(c.rate, span.count - 1).stableNormalized();
  const Vec3 x = mean(c.offset, span.count).cross(z).stableNormalized();
  // Any frame would do: one that does not exist does nothing.
  if (x.squaredNorm() > 0.5) result.rotation << x, z.cross(x), z;
  return result;
}

/// With x = P + R y before and x' = P' + R' y' now, x' - x = P' - P + (R' - R) y + R' (y' - y). A rotation by
/// theta less none has the norm 2 sin(theta / 2), and sqrt(2) times that in Frobenius' sense.
double motion(const UsedSpan& span, const SpanShape& shape, const CurvePair& before, const Placement& from,
              const CurvePair& now, const Placement& to) {
  double radius = 0.0;
  for (const Vec3& x : before.primary().control_points().subspan(span.first, span.count))
    radius = std::max(radius, (x - from.position).squaredNorm());
  const double turned = (to.rotation - from.rotation).norm() / std::sqrt(2.0);
  const double carried = (to.position - from.position).norm() + turned * (std::sqrt(radius) + span.reach);
  return carried * (1.0 + 1e-9) + motion(span, shape, {before, from}, {now, to});
}

}  // namespace tendril::contact
