#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/arc_length.h>

#include <cmath>

#include "curve/projection_cases.h"
#include "support/numbers.h"

namespace tendril {
namespace {

using test::NamedCurve;
using test::Random;

using tendril::test::kNaN;

TEST(ArcLengthOf, AStraightLineAtUnevenSpeedIsTheDistance) {
  const BSpline line = test::uniform_curve(3, {{0, 0, 0}, {1, 2, 2}, {1.5, 3, 3}, {4, 8, 8}, {5, 10, 10}});
  const ArcLength arc(line);
  EXPECT_NEAR(arc.total(), 15.0, 15e-15);
  for (int i = 0; i <= 50; ++i) EXPECT_NEAR(arc.length_to(0.02 * i), line.value(0.02 * i).norm(), 15e-15);
}

/// (t, t^2) from 0 to t: t sqrt(1 + 4 t^2) / 2 + asinh(2 t) / 4.
TEST(ArcLengthOf, AParabolaHasItsClosedForm) {
  const BSpline parabola(KnotVector(2, {-1, -1, -1, 0.3, 2, 2, 2}),
                         {{-1, 1, 0}, {-0.35, -0.3, 0}, {1.15, 0.6, 0}, {2, 4, 0}});
  const auto exact = [](double t) { return t * std::sqrt(1 + 4 * t * t) / 2 + std::asinh(2 * t) / 4; };
  const ArcLength arc(parabola);
  const double total = exact(2.0) - exact(-1.0);
  ASSERT_NEAR((parabola.value(0.7) - Vec3(0.7, 0.49, 0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(arc.total(), total, 1e-14 * total);
  for (int i = 0; i <= 100; ++i) {
    const double t = -1.0 + 0.03 * i;
    EXPECT_NEAR(arc.length_to(t), exact(t) - exact(-1.0), 1e-14 * total) << t;
  }
}

/// c = (x^2, x^3) with x = 1 - 2 t rests at t = 1/2, inside its only span; |c'| = 2 |x| sqrt(4 + 9 x^2).
TEST(ArcLengthOf, ACuspInsideASpanIsExactOnBothSides) {
  const BSpline cusp = test::uniform_curve(3, {{1, 1, 0}, {-1.0 / 3, -1, 0}, {-1.0 / 3, 1, 0}, {1, -1, 0}});
  const auto branch = [](double x) { return (std::pow(4 + 9 * x * x, 1.5) - 8) / 27; };
  const ArcLength arc(cusp);
  ASSERT_LT(cusp.derivative(0.5).norm(), 1e-15);
  EXPECT_NEAR(arc.total(), 2 * branch(1.0), 1e-12);
  for (int i = 0; i <= 40; ++i) {
    const double t = i / 40.0, x = 1 - 2 * t;
    EXPECT_NEAR(arc.length_to(t), branch(1.0) - std::copysign(branch(x), x), 1e-12) << t;
  }
}

TEST(ArcLengthOf, EveryCurveAgreesWithItsFinePolygon) {
  for (const NamedCurve& named : test::projection_curves()) {
    const ArcLength arc(named.curve);
    const auto knots = named.curve.knots().knots();
    constexpr int kEdges = 10000;  // a span
    double polygon = 0.0;
    Vec3 before = named.curve.value(knots.front());
    for (const int span : named.curve.knots().nonempty_spans()) {
      const double a = knots[static_cast<std::size_t>(span)], b = knots[static_cast<std::size_t>(span) + 1];
      for (int i = 1; i <= kEdges; ++i) {
        const Vec3 at = named.curve.value(a + (b - a) * i / kEdges);
        polygon += (at - before).norm();
        before = at;
      }
    }
    EXPECT_NEAR(arc.total(), polygon, 1e-6 * polygon) << named.name;
    EXPECT_LE(polygon, arc.total() * (1 + 1e-11)) << named.name;
  }
}

TEST(ArcLengthOf, EveryCurveRoundTripsAndDoesNotDecrease) {
  for (const NamedCurve& named : test::projection_curves()) {
    const ArcLength arc(named.curve);
    const double start = named.curve.knots().start(), end = named.curve.knots().end();
    double before = 0.0, t_before = start;
    for (int i = 0; i <= 500; ++i) {
      const double s = arc.length_to(start + (end - start) * i / 500);
      EXPECT_GE(s, before) << named.name;
      before = s;
      const double wanted = arc.total() * i / 500;
      const double t = arc.parameter_at(wanted);
      EXPECT_GE(t, t_before) << named.name;
      EXPECT_NEAR(arc.length_to(t), wanted, 1e-14 * arc.total()) << named.name;
      t_before = t;
    }
    EXPECT_EQ(arc.length_to(end), arc.total());
    EXPECT_EQ(arc.parameter_at(-1.0), start);
    EXPECT_EQ(arc.parameter_at(2.0 * arc.total()), arc.parameter_at(arc.total()));
  }
}

TEST(ArcLengthOf, ACurveThatRestsHasTheFirstParameter) {
  const BSpline point = test::uniform_curve(3, std::vector<Vec3>(6, Vec3(1, 2, 3)));
  EXPECT_NEAR(ArcLength(point).total(), 0.0, 1e-14);
  EXPECT_EQ(ArcLength(point).parameter_at(0.0), 0.0);
  const BSpline pause(KnotVector(1, {0, 0, 1, 2, 3, 3}), {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const ArcLength arc(pause);
  EXPECT_DOUBLE_EQ(arc.total(), 2.0);
  EXPECT_DOUBLE_EQ(arc.length_to(1.5), 1.0);
  EXPECT_NEAR(arc.parameter_at(1.0), 1.0, 1e-15);
}

// Infinite lengths do not agree however small the cells are.
TEST(ArcLengthOf, ASpeedWhoseSquareOverflowsIsRefused) {
  const auto from_origin_to = [](double x) {
    return test::uniform_curve(3, {Vec3::Zero(), x * Vec3::UnitX(), x * Vec3::UnitY(), Vec3::Zero()});
  };
  EXPECT_TRUE(std::isfinite(ArcLength(from_origin_to(1e150)).total()));
  EXPECT_THROW(ArcLength(from_origin_to(1e155)), InvalidInput);
  EXPECT_THROW(ArcLength(from_origin_to(1e307)), InvalidInput);
}

TEST(ArcLengthOf, NaNIsRefused) {
  const ArcLength arc(test::projection_curves().front().curve);
  EXPECT_THROW(arc.length_to(kNaN), InvalidInput);
  EXPECT_THROW(arc.parameter_at(kNaN), InvalidInput);
}

}  // namespace
}  // namespace tendril
