#include "span_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tendril::contact {
namespace {

using Column = std::array<Vec3, kMaxDegree + 1>;

/// Bezier points of a span, of its derivative by a parameter of its own, and of n.
struct Controls {
  Column at, rate, offset;
};

template <class Place>
Controls controls(const UsedSpan& span, const CurvePair& pair, const Place& place) {
  const Points u = pair.primary().control_points().subspan(span.first, span.count);
  const Points v = pair.orientation().control_points().subspan(span.first, span.count);
  Column at, offset;
  for (std::size_t i = 0; i < span.count; ++i) {
    at[i] = place(u[i]);
    offset[i] = place(v[i]) - at[i];
  }
  Controls out;
  for (std::size_t k = 0; k < span.count; ++k) {
    out.at[k].setZero();
    out.offset[k].setZero();
    for (std::size_t i = 0; i < span.count; ++i) {
      out.at[k] += span.bezier[k][i] * at[i];
      out.offset[k] += span.bezier[k][i] * offset[i];
    }
    if (k > 0) out.rate[k - 1] = static_cast<double>(span.count - 1) * (out.at[k] - out.at[k - 1]);
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

/// Bezier point k of a span [a, b] is its polar form at p - k times a and k times b [Ramshaw 1989], by de
/// Boor's recurrence with another argument at each level.
UsedSpan::UsedSpan(std::uint32_t of, const KnotVector& knots, int span)
    : pair(of),
      first(static_cast<std::uint32_t>(span - knots.degree())),
      count(static_cast<std::uint32_t>(knots.degree() + 1)),
      bezier{} {
  const auto p = static_cast<std::size_t>(knots.degree());
  const std::span<const double> u = knots.knots();
  for (std::size_t k = 0; k <= p; ++k)
    for (std::size_t unit = 0; unit <= p; ++unit) {
      std::array<double, kMaxDegree + 1> d{};
      d[unit] = 1.0;
      for (std::size_t r = 1; r <= p; ++r) {
        const double at = u[r <= p - k ? first + p : first + p + 1];
        for (std::size_t i = p; i >= r; --i) {
          const std::size_t j = first + i;
          const double part = (at - u[j]) / (u[j + p - r + 1] - u[j]);
          d[i] = (1.0 - part) * d[i - 1] + part * d[i];
        }
      }
      bezier[k][unit] = d[p];
    }
}

/// c' lies in the hull of its Bezier points and so goes at least as far along their mean as the least of
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

namespace {

/// The largest changes of Bezier points of c, of c' and of n.
struct Changes {
  double at, rate, offset;
};

/// a + b of the header.
double turns(const SpanShape& shape, const Changes& most) {
  if (!(most.rate < shape.least_speed)) return std::numeric_limits<double>::infinity();
  const double turn = most.rate / (shape.least_speed - most.rate);
  const double across = most.offset + turn * shape.most_offset;
  if (!(across < shape.least_across)) return std::numeric_limits<double>::infinity();
  return turn + across / (shape.least_across - across);
}

}  // namespace

/// Weights of differences sum to 0, so that they are weights of edges: of edge j, less those of the masses up
/// to j.
SpanGain gain_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation) {
  const std::size_t n = interpolation.size();
  SpanGain gain{0.0, 0.0};
  std::vector<double> before;
  for (std::size_t k = 0; k < span.count; ++k) {
    std::vector<double> row(n, 0.0);
    for (std::size_t i = 0; i < span.count; ++i)
      for (std::size_t j = 0; j < n; ++j) row[j] += span.bezier[k][i] * interpolation[span.first + i][j];
    double sum = 0.0, edges = 0.0, so_far = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      sum += std::abs(row[j]);
      if (k == 0) continue;
      so_far += row[j] - before[j];
      if (j + 1 < n) edges += std::abs(so_far);
    }
    gain.at = std::max(gain.at, sum);
    gain.rate = std::max(gain.rate, static_cast<double>(span.count - 1) * edges);
    before = std::move(row);
  }
  return {gain.at * (1.0 + 1e-9), gain.rate * (1.0 + 1e-9)};
}

double motion(const SpanGain& gain, const UsedSpan& span, const SpanShape& shape, const RodMotion& rod) {
  const double at = gain.at * rod.mass;
  return (at + span.reach * turns(shape, {at, gain.rate * rod.edge, gain.at * rod.arm})) * (1.0 + 1e-9) +
         1e-12 * (gain.at * rod.size + span.reach);
}

double motion(const UsedSpan& span, const SpanShape& shape, const PosedFrom& before, const PosedFrom& now) {
  const Controls a = controls(span, before.pair, [&](const Vec3& x) { return before.solid.to_local(x); });
  const Controls b = controls(span, now.pair, [&](const Vec3& x) { return now.solid.to_local(x); });
  const double turned =
      turns(shape, {0.0, widest(a.rate, b.rate, span.count - 1), widest(a.offset, b.offset, span.count)});
  // Rounding of what is computed here and of vertices is far below this share of the sizes.
  double size = span.reach;
  for (std::size_t i = 0; i < span.count; ++i) size = std::max({size, a.at[i].norm(), b.at[i].norm()});
  return (widest(a.at, b.at, span.count) + span.reach * turned) * (1.0 + 1e-9) + 1e-12 * size;
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
  const Controls c = controls(span, before, [](const Vec3& x) { return x; });
  for (std::size_t i = 0; i < span.count; ++i)
    radius = std::max(radius, (c.at[i] - from.position).squaredNorm());
  const double turned = (to.rotation - from.rotation).norm() / std::sqrt(2.0);
  const double carried = (to.position - from.position).norm() + turned * (std::sqrt(radius) + span.reach);
  return carried * (1.0 + 1e-9) + motion(span, shape, {before, from}, {now, to});
}

}  // namespace tendril::contact
