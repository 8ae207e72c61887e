#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <cmath>

#include "curve/projection_cases.h"
#include "support/numbers.h"

namespace tendril {
namespace {

using test::Random;

using tendril::test::kInfinity;
using tendril::test::kNaN;

TEST(NearestPoint, OnALineIsTheFootOrTheNearerEnd) {
  for (int degree = 1; degree <= 5; ++degree) {
    const BSpline line =
        test::uniform_curve(degree, test::along(degree + 1, [](double s) { return Vec3(4 * s, 0, 0); }));
    const CurveProjector projector(line);
    Random random(static_cast<std::uint64_t>(degree));
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random.in_cube(6.0);
      const Projection at = projector.nearest(p);
      const Vec3 foot(std::clamp(p.x(), 0.0, 4.0), 0, 0);
      EXPECT_NEAR((at.point - foot).norm(), 0.0, 1e-14);
      EXPECT_NEAR(at.distance, (p - foot).norm(), 1e-14);
      EXPECT_NEAR(at.lambda, 1.0, 1e-14);
      EXPECT_EQ(at.kind, p.x() <= 0.0   ? ProjectionKind::start
                         : p.x() >= 4.0 ? ProjectionKind::end
                                        : ProjectionKind::interior);
    }
  }
}

/// y = x^2 from the point (a, b): 2 x^3 + (1 - 2 b) x - a = 0. Here the root is chosen and the point follows.
TEST(NearestPoint, OnAParabolaHasItsClosedForm) {
  const BSpline parabola(KnotVector(2, {-2, -2, -2, 2, 2, 2}), {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}});
  const CurveProjector projector(parabola);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-1.9, 1.9);
    const double along = random.uniform(-3.0, 0.45);  // inside the focal distance on the concave side
    const Vec3 normal(-2 * x, 1, 0);
    const Projection at = projector.nearest(Vec3(x, x * x, 0) + along * normal);
    EXPECT_NEAR(at.t, x, 1e-13);
    EXPECT_NEAR(at.distance, std::abs(along) * normal.norm(), 1e-14);
    EXPECT_NEAR(at.lambda, 1.0 - 2.0 * along / normal.squaredNorm(), 1e-12);
  }
  const Projection focal = projector.nearest(Vec3(0, 0.5, 0));
  EXPECT_NEAR(focal.distance, 0.5, 1e-14);
  EXPECT_NEAR(focal.lambda, 0.0, 1e-6);
}

TEST(NearestPoint, ExactTiesTakeTheSmallestParameter) {
  const BSpline hairpin(KnotVector(1, {0, 0, 1, 2, 3, 3}), {{0, 1, 0}, {4, 1, 0}, {4, -1, 0}, {0, -1, 0}});
  EXPECT_EQ(CurveProjector(hairpin).nearest(Vec3(1, 0, 0)).t, 0.25);
  const BSpline back(KnotVector(1, {0, 0, 1, 2, 2}), {{0, 0, 0}, {4, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(CurveProjector(back).nearest(Vec3(1, 2, 0)).t, 0.25);
  const BSpline closed(KnotVector(1, {0, 0, 1, 2, 3, 3}), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
  EXPECT_EQ(CurveProjector(closed).nearest(Vec3(-1, -1, 0)).kind, ProjectionKind::start);
}

TEST(NearestPoint, OfACornerIsAJoint) {
  const BSpline corner(KnotVector(1, {0, 0, 1, 2, 2}), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  const CurveProjector projector(corner);
  EXPECT_EQ(projector.nearest(Vec3(2, -1, 0)).kind, ProjectionKind::joint);
  EXPECT_EQ(projector.nearest(Vec3(1, 0, 0)).kind, ProjectionKind::joint);
  EXPECT_EQ(projector.nearest(Vec3(0.5, 1e-3, 0)).kind, ProjectionKind::interior);
  const Projection at = projector.nearest(Vec3(2, -1, 0));
  EXPECT_EQ(at.t, 1.0);
  EXPECT_EQ(at.distance, std::sqrt(2.0));
  // A smooth knot is none, exactly there or beside it.
  const BSpline smooth = test::projection_curves().front().curve;
  const double knot = smooth.knots().knots()[5];
  const CurveProjector on_smooth(smooth);
  EXPECT_EQ(on_smooth.nearest(smooth.value(knot)).kind, ProjectionKind::interior);
  const Vec3 side = smooth.derivative(knot).unitOrthogonal();
  EXPECT_EQ(on_smooth.nearest(smooth.value(knot) + 0.1 * side).kind, ProjectionKind::interior);
}

/// (x^2, x^3), x = 1 - 2 t: at rest at the origin for t = 1/2, inside the span.
TEST(NearestPoint, OfACuspIsFoundWhereTheSpeedIsZero) {
  const BSpline cusp = test::uniform_curve(3, {{1, 1, 0}, {-1.0 / 3, -1, 0}, {-1.0 / 3, 1, 0}, {1, -1, 0}});
  const CurveProjector projector(cusp);
  for (const double x : {-1e-9, -1e-3, -0.5, -100.0}) {
    const Projection at = projector.nearest(Vec3(x, 0, 0));
    EXPECT_NEAR(at.distance, -x, 1e-15 * (1 - x)) << x;
    EXPECT_NEAR(at.t, 0.5, 1e-6);
    EXPECT_TRUE(std::isfinite(at.lambda));
  }
  EXPECT_EQ(projector.nearest(Vec3(-1, 0, 0)).kind, ProjectionKind::joint);
  EXPECT_EQ(projector.nearest(Vec3(-1, 0, 0)).lambda, 0.0);
}

/// The false root: the speed is zero at a knot with a triple control point, and the nearest point is
/// elsewhere.
TEST(NearestPoint, IsNotHeldByAFalseRootAtRest) {
  const Vec3 a(0, 0, 0), b(1, 1, 0), c(2, 0, 0);
  const BSpline curve = test::uniform_curve(3, {a, b, b, b, c, c + Vec3(1, 0, 0)});
  const CurveProjector projector(curve);
  test::DenseReference reference(curve, 400);
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 way = random.in_cube();
    const Vec3 p = b + std::pow(10.0, random.uniform(-8.0, 0.0)) * way;
    const Projection at = projector.nearest(p);
    EXPECT_LE(at.distance, reference.distance(p) + 1e-13);
  }
}

TEST(NearestPoint, OfACurveThatIsOnePoint) {
  const BSpline point = test::uniform_curve(3, std::vector<Vec3>(7, Vec3(1, 2, 3)));
  const CurveProjector projector(point);
  const Projection at = projector.nearest(Vec3(1, 2, 5));
  EXPECT_EQ(at.t, 0.0);
  EXPECT_NEAR(at.distance, 2.0, 1e-15);
  EXPECT_LE(at.gap, 1e-13);
  EXPECT_LE(projector.nearest(Vec3(1, 2, 3)).distance, 1e-15);
}

TEST(NearestPoint, IsTheSameForAMovedAndScaledCurve) {
  const BSpline curve = test::projection_curves()[4].curve;
  const CurveProjector projector(curve);
  for (const double scale : {1e-60, 1e-6, 1e5, 1e60}) {
    std::vector<Vec3> points(curve.control_points().begin(), curve.control_points().end());
    for (Vec3& u : points) u *= scale;
    const CurveProjector scaled(BSpline(curve.knots(), points));
    Random random(2);
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random.in_cube(6.0);
      EXPECT_NEAR(scaled.nearest(scale * p).distance / scale, projector.nearest(p).distance, 1e-13);
    }
  }
}

TEST(NearestPoint, AnswersWithTheCurveAtItsParameter) {
  for (const test::NamedCurve& named : test::projection_curves()) {
    const CurveProjector projector(named.curve);
    Random random(6);
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = random.in_cube(8.0);
      const Projection at = projector.nearest(p);
      EXPECT_EQ(at.point, named.curve.value(at.t)) << named.name;
      EXPECT_EQ(at.distance, (at.point - p).norm()) << named.name;
      EXPECT_GE(at.gap, 0.0);
      EXPECT_TRUE(at.kind != ProjectionKind::interior || at.lambda > -1e-6) << named.name;
    }
  }
}

TEST(NearestPoint, RefusesWhatIsNotANumber) {
  const CurveProjector projector(test::projection_curves().front().curve);
  EXPECT_THROW(projector.nearest(Vec3(0, kNaN, 0)), InvalidInput);
  EXPECT_THROW(projector.nearest(Vec3(kInfinity, 0, 0)), InvalidInput);
  EXPECT_THROW(projector.nearest(Vec3(0, 0, 1e200)), InvalidInput);
  EXPECT_THROW(projector.nearest(Vec3(0, 0, 0), kNaN), InvalidInput);
  EXPECT_EQ(projector.nearest(Vec3(0, 0, 0), -kInfinity).t, projector.nearest(Vec3(0, 0, 0)).t);
}

}  // namespace
}  // namespace tendril
