#include "span_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tendril::contact {
namespace {

using Column = std::array<Vec3, kMaxDegree + 1>;

using Controls = SpanControls;

/// \param place  takes a control point to where it is seen from
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

Controls controls_of(const UsedSpan& span, const CurvePair& pair) {
  return controls(span, pair, [](const Vec3& x) { return x; });
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

SpanShape shape_of(const UsedSpan& span, const Controls& a, const Controls& b);

}  // namespace

/// Bezier point k of a span [a, b] is its polar form at p - k times a and k times b [Ramshaw 1989], by de
/// Boor's recurrence with another argument at each level.
UsedSpan::UsedSpan(std::uint32_t of, const KnotVector& knots, int span, int part, int parts)
    : pair(of),
      first(static_cast<std::uint32_t>(span - knots.degree())),
      count(static_cast<std::uint32_t>(knots.degree() + 1)),
      bezier{} {
  const auto p = static_cast<std::size_t>(knots.degree());
  const std::span<const double> u = knots.knots();
  const auto end = [&](int i) {
    const double share = static_cast<double>(i) / parts;
    return (1.0 - share) * u[first + p] + share * u[first + p + 1];
  };
  const double from = end(part), to = end(part + 1);
  for (std::size_t k = 0; k <= p; ++k)
    for (std::size_t unit = 0; unit <= p; ++unit) {
      std::array<double, kMaxDegree + 1> d{};
      d[unit] = 1.0;
      for (std::size_t r = 1; r <= p; ++r) {
        const double at = r <= p - k ? from : to;
        for (std::size_t i = p; i >= r; --i) {
          const std::size_t j = first + i;
          const double share = (at - u[j]) / (u[j + p - r + 1] - u[j]);
          d[i] = (1.0 - share) * d[i - 1] + share * d[i];
        }
      }
      bezier[k][unit] = d[p];
    }
}

SpanShape shape_of(const UsedSpan& span, const CurvePair& pair) {
  const Controls here = controls_of(span, pair);
  return shape_of(span, here, here);
}

namespace {

/// c' lies in the hull of its Bezier points and so goes at least as far along their mean as the least of
/// them does; n likewise along e, the part of its mean across that of c'. Of n' = n - (n . Z) Z along e
/// that leaves at least min n . e - |n| max |Z . e|. Points that go straight are least, or farthest, at one
/// end of their way.
SpanShape shape_of(const UsedSpan& span, const Controls& a, const Controls& b) {
  const std::size_t rates = span.count - 1;
  const Vec3 along = (mean(a.rate, rates) + mean(b.rate, rates)).stableNormalized();
  const double speed = std::min(least_along(a.rate, rates, along), least_along(b.rate, rates, along));
  const Vec3 offset = mean(a.offset, span.count) + mean(b.offset, span.count);
  const Vec3 across = (offset - offset.dot(along) * along).stableNormalized();
  double aside = 0.0, longest = 0.0, least = std::numeric_limits<double>::infinity();
  for (const Controls* c : {&a, &b}) {
    for (std::size_t i = 0; i < rates; ++i) aside = std::max(aside, std::abs(c->rate[i].dot(across)));
    for (std::size_t i = 0; i < span.count; ++i) longest = std::max(longest, c->offset[i].norm());
    least = std::min(least, least_along(c->offset, span.count, across));
  }
  if (!(speed > 0.0)) return {0.0, 0.0, longest};
  return {speed, least - longest * aside / speed, longest};
}

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

namespace {

/// Weights of a span's Bezier points by masses, and of the differences of two by edges. Weights of
/// differences sum to 0, so that they are weights of edges: of edge j, less those of the masses up to j.
struct Weights {
  std::vector<std::vector<double>> at, rate;  ///< per Bezier point
};
Weights weights_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation) {
  const std::size_t n = interpolation.size();
  Weights result;
  for (std::size_t k = 0; k < span.count; ++k) {
    std::vector<double> row(n, 0.0), edges(n, 0.0);
    for (std::size_t i = 0; i < span.count; ++i)
      for (std::size_t j = 0; j < n; ++j) row[j] += span.bezier[k][i] * interpolation[span.first + i][j];
    double so_far = 0.0;
    for (std::size_t j = 0; k > 0 && j + 1 < n; ++j) {
      so_far += row[j] - result.at.back()[j];
      edges[j] = static_cast<double>(span.count - 1) * so_far;
    }
    result.at.push_back(std::move(row));
    result.rate.push_back(std::move(edges));
  }
  return result;
}

/// Rounding of these sums.
constexpr double kUp = 1.0 + 1e-9;

double sum_outside(const std::vector<double>& row, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t j = 0; j < row.size(); ++j)
    if (j < first || j >= first + count) sum += std::abs(row[j]);
  return sum;
}

/// What masses farther away have less weight than this is lumped.
constexpr double kFewWeigh = 0.01;

}  // namespace

SpanGain gain_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation) {
  const Weights weights = weights_of(span, interpolation);
  SpanGain gain{0.0, 0.0};
  for (std::size_t k = 0; k < span.count; ++k) {
    gain.at = std::max(gain.at, kUp * sum_outside(weights.at[k], 0, 0));
    gain.rate = std::max(gain.rate, kUp * sum_outside(weights.rate[k], 0, 0));
  }
  return gain;
}

LocalGain local_gain_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation) {
  const Weights weights = weights_of(span, interpolation);
  LocalGain gain;
  std::size_t first = interpolation.size(), last = 0;
  for (std::size_t k = 0; k < span.count; ++k)
    for (std::size_t j = 0; j < interpolation.size(); ++j)
      if (std::abs(weights.at[k][j]) > kFewWeigh || std::abs(weights.rate[k][j]) > kFewWeigh)
        first = std::min(first, j), last = std::max(last, j + 1);
  gain.first = first;
  gain.count = last - first;
  for (std::size_t k = 0; k < span.count; ++k) {
    for (std::size_t j = first; j < last; ++j) {
      gain.at.push_back(kUp * std::abs(weights.at[k][j]));
      gain.rate.push_back(kUp * std::abs(weights.rate[k][j]));
    }
    gain.all = std::max(gain.all, sum_outside(weights.at[k], 0, 0));
    gain.at_rest = std::max(gain.at_rest, kUp * sum_outside(weights.at[k], first, gain.count));
    gain.rate_rest = std::max(gain.rate_rest, kUp * sum_outside(weights.rate[k], first, gain.count));
  }
  return gain;
}

namespace {

/// The largest over Bezier points.
double weighed(const std::vector<double>& weights, std::size_t count, double rest, const double* motions,
               double most) {
  double largest = 0.0;
  for (std::size_t k = 0; k < weights.size(); k += count) {
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) sum += weights[k + j] * motions[j];
    largest = std::max(largest, sum);
  }
  return largest + rest * most;
}

}  // namespace

double motion(const LocalGain& gain, const UsedSpan& span, const SpanShape& shape, const RodMotion& most,
              const MassMotions& masses) {
  const auto by = [&](const std::vector<double>& weights, double rest, const std::vector<double>& of,
                      double largest) {
    return weighed(weights, gain.count, rest, &of[gain.first], largest);
  };
  const double at = by(gain.at, gain.at_rest, masses.mass, most.mass);
  const double rate = by(gain.rate, gain.rate_rest, masses.edge, most.edge);
  const double arm = by(gain.at, gain.at_rest, masses.arm, most.arm);
  return (at + span.reach * turns(shape, {at, rate, arm})) * kUp +
         1e-12 * (gain.all * most.size + span.reach);
}

double motion(const SpanGain& gain, double reach, const SpanShape& shape, const RodMotion& rod) {
  const double at = gain.at * rod.mass;
  return (at + reach * turns(shape, {at, gain.rate * rod.edge, gain.at * rod.arm})) * (1.0 + 1e-9) +
         1e-12 * (gain.at * rod.size + reach);
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

namespace {

/// The largest components of some points along a direction and across it.
struct Extent {
  double along = 0.0, across = 0.0;
  void take(const Vec3& x, const Vec3& way) {
    const double to = x.dot(way);
    along = std::max(along, std::abs(to));
    across = std::max(across, (x - to * way).norm());
  }
};

double bow_of(const UsedSpan& span, const SpanWay& way, const Controls& there) {
  const std::size_t rates = span.count - 1;
  const Vec3 z = (mean(way.at.rate, rates) + mean(there.rate, rates)).stableNormalized();
  Extent of_d, of_e, of_rate, of_n;
  for (std::size_t i = 0; i < rates; ++i) {
    of_d.take(way.change.rate[i], z);
    of_rate.take(way.at.rate[i], z);
    of_rate.take(there.rate[i], z);
  }
  for (std::size_t i = 0; i < span.count; ++i) {
    of_e.take(way.change.offset[i], z);
    of_n.take(way.at.offset[i], z);
    of_n.take(there.offset[i], z);
  }
  const double d = std::hypot(of_d.along, of_d.across), e = std::hypot(of_e.along, of_e.across);
  if (d == 0.0 && e == 0.0) return 0.0;
  const auto [s, m, n] = way.shape;
  if (!(s > 0.0) || !(m > 0.0)) return std::numeric_limits<double>::infinity();
  const double aslant = std::min(2.0, of_rate.across / s);  // |Z - z|
  const double a = d / s, p = (of_d.along + d * aslant) / s;
  const double e_across = of_e.across + e * aslant, n_along = of_n.along + n * aslant;
  const double z2 = a * a + 2.0 * a * p, n_z2 = n_along * a * a + 2.0 * n * a * p;
  const double b = (e_across + n * a + n_along * a) / m;
  const double m2 = 2.0 * e_across * a + n_z2 + 2.0 * (e + n * a) * a + n_along * z2;
  const double y2 = m2 / m + b * b + 2.0 * b * (e_across + n_along * a) / m;
  return (y2 + 2.0 * a * b + z2) * span.reach / 8.0 * kUp;
}

}  // namespace

SpanWay way_of(const UsedSpan& span, const CurvePair& from, const CurvePair& to) {
  SpanWay way;
  way.at = controls_of(span, from);
  const Controls there = controls_of(span, to);
  way.shape = shape_of(span, way.at, there);
  for (std::size_t i = 0; i < span.count; ++i) {
    way.change.at[i] = there.at[i] - way.at.at[i];
    way.change.offset[i] = there.offset[i] - way.at.offset[i];
    way.change.rate[i].setZero();
    if (i + 1 < span.count) way.change.rate[i] = there.rate[i] - way.at.rate[i];
  }
  way.bow = bow_of(span, way, there);
  return way;
}

double motion(const UsedSpan& span, const SpanWay& way, double share, const CurvePair& pair) {
  const Controls now = controls_of(span, pair);
  double at = 0.0, rate = 0.0, offset = 0.0, size = 0.0;
  for (std::size_t i = 0; i < span.count; ++i) {
    at = std::max(at, (now.at[i] - way.at.at[i] - share * way.change.at[i]).squaredNorm());
    offset =
        std::max(offset, (now.offset[i] - way.at.offset[i] - share * way.change.offset[i]).squaredNorm());
    size = std::max(size, now.at[i].squaredNorm());
    if (i + 1 < span.count)
      rate = std::max(rate, (now.rate[i] - way.at.rate[i] - share * way.change.rate[i]).squaredNorm());
  }
  const double turned = turns(way.shape, {0.0, std::sqrt(rate), std::sqrt(offset)});
  return (std::sqrt(at) + span.reach * turned + strays(way.bow, share)) * kUp +
         1e-12 * (2.0 * std::sqrt(size) + std::sqrt(at) + span.reach);
}

}  // namespace tendril::contact
