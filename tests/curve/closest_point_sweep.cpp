#include <gtest/gtest.h>
#include <tendril/curve/closest_point.h>

#include <chrono>
#include <cstdio>

#include "curve/projection_cases.h"

// Nearest points on every curve of projection_cases.h against the dense reference. TENDRIL_SWEEP_POINTS is
// the number of points over all curves.
namespace tendril {
namespace {

using test::DenseReference;
using test::HardPoints;
using test::NamedCurve;
using test::Random;

constexpr int kPoints = TENDRIL_SWEEP_POINTS;

struct Worst {
  double excess = 0.0;   // of the distance over the reference, in sizes
  double deficit = 0.0;  // of the reference under distance - gap, in sizes
  double gap = 0.0;      // in sizes
  int hint_differs = 0;
};

bool same(const Projection& a, const Projection& b) {
  return a.t == b.t && a.point == b.point && a.distance == b.distance && a.kind == b.kind &&
         a.lambda == b.lambda && a.gap == b.gap;
}

void compare(const Projection& found, double reference, double size, Worst& worst) {
  worst.excess = std::max(worst.excess, (found.distance - reference) / size);
  worst.deficit = std::max(worst.deficit, (found.distance - found.gap - reference) / size);
  worst.gap = std::max(worst.gap, found.gap / size);
}

class EveryCurve : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Curves, EveryCurve, testing::Range(0, 12));

TEST_P(EveryCurve, NearestIsNotBeatenByTheReference) {
  const NamedCurve named = test::projection_curves().at(static_cast<std::size_t>(GetParam()));
  const BSpline& curve = named.curve;
  const CurveProjector projector(curve);
  HardPoints source(curve, projector, 1000 + static_cast<std::uint64_t>(GetParam()));
  std::vector<Vec3> points;
  for (int i = 0; i < (kPoints + 11) / 12; ++i) points.push_back(source.next());

  std::vector<Projection> found;
  found.reserve(points.size());
  const auto start = std::chrono::steady_clock::now();
  for (const Vec3& p : points) found.push_back(projector.nearest(p));
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;

  DenseReference reference(curve, 128);
  Random random(9);
  Worst worst;
  const double extent = test::diagonal(curve);
  for (std::size_t i = 0; i < points.size(); ++i) {
    compare(found[i], reference.distance(points[i]), extent + found[i].distance, worst);
    const double hint = random.uniform(curve.knots().start(), curve.knots().end());
    if (!same(found[i], projector.nearest(points[i], i % 2 == 0 ? found[i].t : hint))) ++worst.hint_differs;
  }
  std::printf("%-24s %8zu points  excess %.1e  deficit %.1e  gap %.1e  %.2f us a point\n", named.name.c_str(),
              points.size(), worst.excess, worst.deficit, worst.gap,
              time.count() / static_cast<double>(points.size()));
  EXPECT_LE(worst.excess, 1e-12);
  EXPECT_EQ(worst.deficit, 0.0);  // the proof covers the rounding of both evaluations
  EXPECT_LE(worst.gap, 1e-12);
  EXPECT_EQ(worst.hint_differs, 0);
}

}  // namespace
}  // namespace tendril
