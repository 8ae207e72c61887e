#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <limits>

#include "curve/projection_cases.h"

namespace tendril {
namespace {

const BSpline kHairpin(KnotVector(1, {0, 0, 1, 2, 3, 3}), {{0, 1, 0}, {4, 1, 0}, {4, -1, 0}, {0, -1, 0}});

TEST(AllMinima, OfAHairpinAreItsSidesWithinTheBand) {
  const CurveProjector projector(kHairpin);
  const Vec3 p(1, 0.1, 0);
  EXPECT_EQ(projector.all(p, 0.1).size(), 1U);
  const std::vector<LocalMinimum> two = projector.all(p, 0.25);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].t, projector.nearest(p).t);
  EXPECT_NEAR(two[1].t, 2.75, 1e-15);
  EXPECT_NEAR(two[1].distance, 1.1, 1e-15);
  EXPECT_EQ(projector.all(p, std::numeric_limits<double>::infinity()).size(), 3U);
}

TEST(AllMinima, OfATieAreBoth) {
  const std::vector<LocalMinimum> tie = CurveProjector(kHairpin).all(Vec3(1, 0, 0), 0.0);
  ASSERT_EQ(tie.size(), 2U);
  EXPECT_EQ(tie[0].t, 0.25);
  EXPECT_EQ(tie[1].t, 2.75);
}

/// A point in the normal plane of a smooth joint has one minimum there, whichever way either side rounds.
TEST(AllMinima, AtASmoothJointAreOne) {
  const BSpline curve = test::projection_curves().front().curve;
  const CurveProjector projector(curve);
  test::Random random(4);
  for (const int span : curve.knots().nonempty_spans()) {
    const double knot = curve.knots().knots()[static_cast<std::size_t>(span)];
    for (int i = 0; i < 200; ++i) {
      const Vec3 side = curve.derivative(knot).cross(random.in_cube()).normalized();
      const auto all = projector.all(curve.value(knot) + random.uniform(1e-9, 0.3) * side, 0.01);
      EXPECT_EQ(all.size(), 1U) << knot;
      EXPECT_NEAR(all[0].t, knot, 1e-12);
      EXPECT_FALSE(all[0].cluster);
    }
  }
}

/// y = x^2 and its focal point (0, 1/2), where the slope of the distance has a triple root that no halving
/// meets.
TEST(AllMinima, AtAFocalPointAreACluster) {
  const BSpline parabola(KnotVector(2, {-2, -2, -2, 3, 3, 3}), {{-2, 4, 0}, {0.5, -6, 0}, {3, 9, 0}});
  const CurveProjector projector(parabola);
  const auto focus = projector.all(Vec3(0, 0.5, 0), 1.0);
  ASSERT_EQ(focus.size(), 1U);
  EXPECT_TRUE(focus[0].cluster);
  EXPECT_EQ(focus[0].multiplicity, 3);
  EXPECT_NEAR(focus[0].strength, 0.0, 1e-6);
  // Beside it two minima part: x^2 = b - 1/2, told apart although their distances differ by less than
  // rounding.
  for (const double height : {1e-2, 1e-6, 1e-10, 1e-14}) {
    const auto two = projector.all(Vec3(0, 0.5 + height, 0), 1.0);
    ASSERT_EQ(two.size(), 2U) << height;
    EXPECT_NEAR(std::abs(two[1].t), std::sqrt(height), 1e-9);
    EXPECT_FALSE(two[0].cluster || two[1].cluster);
  }
}

/// Strength: lambda inside; it goes on without a jump into an end and over a kink, and vanishes at birth.
TEST(AllMinima, HaveAStrengthThatIsContinuous) {
  const BSpline corner(KnotVector(2, {0, 0, 0, 1, 1, 2, 2, 2}),
                       {{0, 0, 0}, {1, 0.2, 0}, {2, 0, 0}, {2.2, 1, 0}, {2, 2, 0}});
  const CurveProjector projector(corner);
  for (const double knot : {0.0, 1.0, 2.0}) {
    for (const double inward : {-1e-9, 1e-9, -1e-7, 1e-7}) {
      const double depth = std::abs(inward);
      const double inside = knot == 1.0 ? knot + inward : knot + (knot == 0.0 ? depth : -depth);
      const Vec3 d1 = corner.derivative(inside);
      const Vec3 normal = Vec3(d1.y(), -d1.x(), 0).normalized();
      const double side = knot == 1.0 ? 1.0 : -1.0;
      const Vec3 p = corner.value(inside) + side * 0.3 * normal;
      const Vec3 outward = (knot == 0.0 || (knot == 1.0 && inward > 0) ? -1.0 : 1.0) * d1.normalized();
      const auto here = projector.all(p, 0.0),
                 beyond = projector.all(p + std::max(1e-7, 10.0 * depth) * outward, 0.0);
      // Nearer to the knot the distances to the place and to the knot are the same number.
      if (depth > 1e-8) EXPECT_EQ(here.front().kind, ProjectionKind::interior);
      EXPECT_NE(beyond.front().kind, ProjectionKind::interior);
      EXPECT_NEAR(here.front().strength, beyond.front().strength, 1e-5) << knot;
      EXPECT_GT(here.front().strength, 0.5);
    }
  }
  // The end of a curve bent round p is born a minimum where the offset is orthogonal to it, with lambda < 0.
  const BSpline parabola(KnotVector(2, {-2, -2, -2, 2, 2, 2}), {{-2, 4, 0}, {0, -4, 0}, {2, 4, 0}});
  const Vec3 end(2, 4, 0), across = Vec3(-4, 1, 0).normalized(), along = Vec3(1, 4, 0).normalized();
  const auto born = CurveProjector(parabola).all(end + 40.0 * across + 1e-6 * along, 10.0);
  ASSERT_EQ(born.back().kind, ProjectionKind::end);
  EXPECT_NEAR(born.back().strength, 0.0, 1e-6);
}

TEST(AllMinima, RefusesABandThatIsNone) {
  const CurveProjector projector(kHairpin);
  EXPECT_THROW(projector.all(Vec3(0, 0, 0), -0.1), InvalidInput);
  EXPECT_THROW(projector.all(Vec3(0, 0, 0), std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}

}  // namespace
}  // namespace tendril
