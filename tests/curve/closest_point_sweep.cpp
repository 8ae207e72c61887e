#include <gtest/gtest.h>
#include <tendril/curve/closest_point.h>

#include <cstdio>

#include "curve/minima_cases.h"
#include "support/certified_distance.h"

// Nearest points, all at once, on every curve of minima_cases.h: that none is nearer by more than the gap
// is proven for each, by arithmetic of its own. Some are asked for one by one too. TENDRIL_SWEEP_POINTS is
// the number of points over all curves.
namespace tendril {
namespace {

using test::CertifiedDistance;
using test::HardPoints;
using test::NamedCurve;
using test::Random;
using test::same;

constexpr int kCurves = 62;
constexpr int kPoints = TENDRIL_SWEEP_POINTS / kCurves + 1;

struct Tally {
  long points = 0, wrong = 0, undecided = 0, far_from_curve = 0, other_alone = 0;
  double gap = 0.0;  // greatest, in sizes
};

/// The gap is taken at its word, but for the rounding of the proof.
/// \param extent  of the curve
void judge(const BSpline& curve, const CertifiedDistance& certified, double extent, const Vec3& p,
           const Projection& found, Tally& tally) {
  const double size = extent + found.distance + p.norm();
  const auto answer = certified.ask(p, found.distance - found.gap - 1e-17 * size);
  tally.wrong += answer == CertifiedDistance::nearer;
  tally.undecided += answer == CertifiedDistance::undecided;
  // On the curve, and as far as it says.
  const Vec3 at = curve.value(found.t);
  tally.far_from_curve += at != found.point || std::abs((at - p).norm() - found.distance) > 1e-15 * size;
  tally.gap = std::max(tally.gap, found.gap / size);
  ++tally.points;
}

class EveryCurve : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Curves, EveryCurve, testing::Range(0, kCurves));

TEST_P(EveryCurve, NoPointIsNearerThanTheNearest) {
  const NamedCurve named = test::minima_curves().at(static_cast<std::size_t>(GetParam()));
  const BSpline& curve = named.curve;
  const CurveProjector projector(curve);
  const CertifiedDistance certified(curve);
  HardPoints source(curve, projector, 1000 + static_cast<std::uint64_t>(GetParam()));
  Random random(9);
  const double extent = test::diagonal(curve);
  Tally tally;
  while (tally.points < kPoints) {
    std::vector<Vec3> points;
    for (int i = 0; i < std::min(10000L, kPoints - tally.points); ++i) points.push_back(source.next());
    const std::vector<Projection> found = projector.nearest(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      judge(curve, certified, extent, points[i], found[i], tally);
      if (i % 8 != 0) continue;
      const double hint = random.uniform(curve.knots().start(), curve.knots().end());
      tally.other_alone += !same(found[i], projector.nearest(points[i]));
      tally.other_alone += !same(found[i], projector.nearest(points[i], i % 16 == 0 ? found[i].t : hint));
    }
  }
  std::printf("%-32s %8ld points, wrong %ld, gap at most %.1e\n", named.name.c_str(), tally.points,
              tally.wrong, tally.gap);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.undecided, 0);
  EXPECT_EQ(tally.far_from_curve, 0);
  EXPECT_EQ(tally.other_alone, 0);
  EXPECT_LE(tally.gap, 1e-12);
}

}  // namespace
}  // namespace tendril
