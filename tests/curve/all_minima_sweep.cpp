#include <gtest/gtest.h>
#include <tendril/curve/closest_point.h>

#include <chrono>
#include <cstdio>

#include "curve/minima_cases.h"
#include "support/exact_minima.h"

// All local minima, and the nearest, on every curve of minima_cases.h against exact root isolation; the
// nearest of many at once must be the same. TENDRIL_SWEEP_POINTS is the number of points over all curves.
namespace tendril {
namespace {

using test::Critical;
using test::ExactMinima;
using test::HardPoints;
using test::NamedCurve;
using test::Random;

constexpr int kPoints = TENDRIL_SWEEP_POINTS;
constexpr double kApart = 1e-8;  // of a span: critical points farther apart must be told apart
constexpr int kCurves = 62;

struct Tally {
  long points = 0, minima = 0, missed = 0, invented = 0, clusters = 0, needless_clusters = 0,
       wrong_nearest = 0, wrong_distance = 0, other_in_batch = 0;
  double nearest_us = 0.0, all_us = 0.0;
};

bool isolated(const std::vector<Critical>& all, std::size_t i) {
  const auto apart = [&](const Critical& a, const Critical& b) {
    return b.low - a.high > kApart * std::max(a.span, b.span);
  };
  // A point of the curve's own rest: a root of order 5 or more, as good as so many in one place.
  return !all[i].zone && all[i].order < 5 && (i == 0 || apart(all[i - 1], all[i])) &&
         (i + 1 == all.size() || apart(all[i], all[i + 1]));
}

/// Number of minima found between the critical points beside number i, and how many are too many there.
struct InPlace {
  int found = 0, excess = 0;
};
InPlace in_place(const std::vector<LocalMinimum>& found, const std::vector<Critical>& all, std::size_t i) {
  const double grain = 1e-9 * all[i].span;
  const double low = i == 0 ? -1e300 : all[i - 1].high - grain;
  const double high = i + 1 == all.size() ? 1e300 : all[i + 1].low + grain;
  InPlace here;
  for (const LocalMinimum& m : found) here.found += m.t >= low && m.t <= high && !m.cluster;
  // The nearest may sit on a maximum that is within rounding of the minima beside it: judged by its distance.
  here.excess = here.found - (found.front().t >= low && found.front().t <= high);
  for (const Critical& c : all) here.excess -= c.minimum && c.t >= low - grain && c.t <= high + grain;
  return here;
}

bool explained(const LocalMinimum& m, const std::vector<Critical>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double reach = 1e-6 * all[i].span;
    if (m.cluster && isolated(all, i) && all[i].minimum) continue;
    if (m.t >= all[i].low - reach && m.t <= all[i].high + reach && (m.cluster || all[i].minimum)) return true;
  }
  return false;
}

void judge(const BSpline& curve, const Vec3& p, double size, double band,
           const std::vector<LocalMinimum>& found, const std::vector<Critical>& all, Tally& tally) {
  const double nearest = found.front().distance;
  const double cut = (1.0 + band) * nearest;
  const double rounding = 1e-13 * size;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double d = (curve.value(all[i].t) - p).norm();
    if (d < nearest - found.front().gap - 1e-12 * size) ++tally.wrong_nearest;
    if (!all[i].minimum || !isolated(all, i) || d > cut - rounding) continue;
    ++tally.minima;
    const InPlace here = in_place(found, all, i);
    if (here.found == 0) ++tally.missed;
    if (here.excess > 0) tally.invented += here.excess;
    for (const LocalMinimum& m : found)
      if (std::abs(m.t - all[i].t) < 1e-7 * all[i].span && !m.cluster &&
          std::abs(m.distance - d) > m.gap + rounding)
        ++tally.wrong_distance;
  }
  for (const LocalMinimum& m : found) {
    if (m.cluster) ++tally.clusters;
    // The nearest may sit on a maximum that is within rounding of the minima beside it: judged by its
    // distance.
    const bool by_distance = &m == &found.front() && !m.cluster;
    if (!by_distance && m.distance > 1e-12 * size && !explained(m, all))
      ++(m.cluster ? tally.needless_clusters : tally.invented);
  }
}

template <class F>
double microseconds(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// Points that were searched one by one, all at once.
void judge_batch(const CurveProjector& projector, std::vector<Vec3>& points, std::vector<Projection>& alone,
                 Tally& tally) {
  const std::vector<Projection> many = projector.nearest(points);
  for (std::size_t i = 0; i < points.size(); ++i) tally.other_in_batch += !test::same(many[i], alone[i]);
  points.clear();
  alone.clear();
}

class EveryCurve : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Curves, EveryCurve, testing::Range(0, kCurves));

TEST_P(EveryCurve, HasTheMinimaThatExactArithmeticFinds) {
  const NamedCurve named = test::minima_curves().at(static_cast<std::size_t>(GetParam()));
  const CurveProjector projector(named.curve);
  HardPoints source(named.curve, projector, 2000 + static_cast<std::uint64_t>(GetParam()));
  ExactMinima exact(named.curve);
  const double extent = test::diagonal(named.curve);
  Random random(static_cast<std::uint64_t>(GetParam()));
  Tally tally;
  std::vector<LocalMinimum> found;
  std::vector<Vec3> points;
  std::vector<Projection> alone;
  for (int i = 0; i < kPoints / kCurves + 1; ++i) {
    Vec3 p = source.next();
    if (i % 11 == 0) p.y() = 0.0;
    const double band = i % 3 == 0 ? 1e-3 : random.uniform(0.0, 3.0);
    points.push_back(p);
    tally.nearest_us += microseconds([&] { alone.push_back(projector.nearest(p)); });
    if (points.size() == 5000) judge_batch(projector, points, alone, tally);
    tally.all_us += microseconds([&] { found = projector.all(p, band); });
    const double nearest = found.front().distance;
    const double size = extent + nearest + p.norm();
    const auto all = exact.critical(p, (1.0 + band) * nearest + 1e-9 * size);
    judge(named.curve, p, size, band, found, all, tally);
    ++tally.points;
  }
  judge_batch(projector, points, alone, tally);
  const double count = static_cast<double>(tally.points);
  std::printf("%-32s %8ld points %8ld minima %5ld clusters  %.2f us nearest, %.2f us all\n",
              named.name.c_str(), tally.points, tally.minima, tally.clusters, tally.nearest_us / count,
              tally.all_us / count);
  EXPECT_EQ(tally.missed, 0);
  EXPECT_EQ(tally.invented, 0);
  EXPECT_EQ(tally.needless_clusters, 0);
  EXPECT_EQ(tally.wrong_nearest, 0);
  EXPECT_EQ(tally.wrong_distance, 0);
  EXPECT_EQ(tally.other_in_batch, 0);
}

}  // namespace
}  // namespace tendril
