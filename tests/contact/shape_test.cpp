#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/contact/law.h>
#include <tendril/contact/shape.h>

#include <cmath>
#include <functional>
#include <string>

#include "support/random.h"

namespace tendril::contact {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Case {
  std::string name;
  ShapePtr shape;
  std::function<bool(const Vec3&)> holds;  ///< whether a point is in the solid
};

std::vector<Case> cases() {
  const auto rho = [](const Vec3& x) { return std::hypot(x.x(), x.y()); };
  const auto box_half = Vec3(0.7, 0.4, 0.2);
  return {{"half space", half_space(), [](const Vec3& x) { return x.z() <= 0.0; }},
          {"ball", ball(0.6), [](const Vec3& x) { return x.norm() <= 0.6; }},
          {"capsule", capsule(0.5, 0.3),
           [](const Vec3& x) { return (x - Vec3(0, 0, std::clamp(x.z(), -0.5, 0.5))).norm() <= 0.3; }},
          {"box", box(box_half), [=](const Vec3& x) { return (x.cwiseAbs() - box_half).maxCoeff() <= 0.0; }},
          {"cylinder", cylinder(0.5, 0.4),
           [=](const Vec3& x) { return rho(x) <= 0.5 && std::abs(x.z()) <= 0.4; }},
          {"drum", cylinder(0.5, kInfinite), [=](const Vec3& x) { return rho(x) <= 0.5; }},
          {"tube", tube(0.4, 0.7, 0.5),
           [=](const Vec3& x) { return rho(x) >= 0.4 && rho(x) <= 0.7 && std::abs(x.z()) <= 0.5; }},
          {"bore", tube(0.4, kInfinite, kInfinite), [=](const Vec3& x) { return rho(x) >= 0.4; }}};
}

/// Walks outwards and inwards along the normal by the distance: just short of it nothing changed, just beyond
/// it the other side is reached. With slopes of at most 1 the value is then the distance.
TEST(Shapes, GiveTheDistanceToTheirSurface) {
  test::Random random(1);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 x = random.in_cube(1.0), y = x + random.in_cube(0.1);
      const SignedDistance at = c.shape->at(x);
      ASSERT_EQ(at.value <= 0.0, c.holds(x));
      EXPECT_EQ(c.shape->distance(x), at.value);
      EXPECT_LE(std::abs(c.shape->distance(y) - at.value), (y - x).norm() * (1.0 + 1e-12));
      EXPECT_NEAR(at.normal.norm(), 1.0, 1e-14);
      const Vec3 way = at.value * at.normal;
      EXPECT_EQ(c.holds(x - (1.0 - 1e-9) * way), c.holds(x)) << x.transpose();
      EXPECT_EQ(c.holds(x - (1.0 + 1e-9) * way), !c.holds(x)) << x.transpose();
    }
  }
}

TEST(Shapes, GiveTheDistancesDerivatives) {
  test::Random random(2);
  const double h = 1e-5;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    int smooth = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 x = random.in_cube(1.0);
      const SignedDistance at = c.shape->at(x);
      Vec3 gradient;
      Mat3 hessian;
      bool kink = false;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Vec3 step = h * Vec3::Unit(k);
        const SignedDistance before = c.shape->at(x - step), after = c.shape->at(x + step);
        gradient[k] = (after.value - before.value) / (2 * h);
        hessian.col(k) = (after.normal - before.normal) / (2 * h);
        kink = kink || (before.curvature - after.curvature).norm() > 1e-3 * (1.0 + at.curvature.norm()) ||
               (after.normal - before.normal).norm() > 1e-2;
      }
      if (kink) continue;
      ++smooth;
      EXPECT_LE((gradient - at.normal).norm(), 1e-7) << x.transpose();
      EXPECT_LE((hessian - at.curvature).norm(), 1e-6 * (1.0 + at.curvature.squaredNorm())) << x.transpose();
    }
    EXPECT_GT(smooth, 900);
  }
}

/// A line between points on the surface of a shape with an outward radius enters it by its sagitta at most.
TEST(Shapes, BendOutwardByNoMoreThanTheySay) {
  test::Random random(3);
  for (const Case& c : cases()) {
    const double radius = c.shape->outward_radius();
    if (!(radius > 0.0 && radius < kInfinite)) continue;
    SCOPED_TRACE(c.name);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 x = random.in_cube(1.0), y = x + random.in_cube(0.2);
      if (c.shape->distance(x) < 0.0 || c.shape->distance(y) < 0.0) continue;
      EXPECT_GE(c.shape->distance(0.5 * (x + y)), -(x - y).squaredNorm() / (8.0 * radius) * 1.05);
    }
  }
}

TEST(Shapes, RefuseNumbersOutOfRange) {
  for (const double bad : {0.0, -1.0, std::nan(""), kInfinite}) {
    EXPECT_THROW(ball(bad), InvalidInput);
    EXPECT_THROW(capsule(1.0, bad), InvalidInput);
    EXPECT_THROW(box({1.0, bad, 1.0}), InvalidInput);
    EXPECT_THROW(cylinder(bad, 1.0), InvalidInput);
    EXPECT_THROW(tube(bad, 2.0, 1.0), InvalidInput);
  }
  EXPECT_THROW(capsule(-1.0, 1.0), InvalidInput);
  EXPECT_THROW(tube(2.0, 1.0, 1.0), InvalidInput);
  EXPECT_THROW(cylinder(1.0, std::nan("")), InvalidInput);
}

TEST(Potentials, HaveTheirDerivatives) {
  for (const Law::Kind kind : {Law::Kind::barrier, Law::Kind::penalty}) {
    Law law;
    law.kind = kind;
    law.range = 0.1;
    for (const double gap : {0.001, 0.02, 0.05, 0.09, 0.0999}) {
      const double h = 1e-6 * gap;
      const Potential at = potential(law, gap), before = potential(law, gap - h),
                      after = potential(law, gap + h);
      EXPECT_NEAR((after.value - before.value) / (2 * h), at.slope, 1e-7 * (1.0 + std::abs(at.slope)));
      EXPECT_NEAR((after.slope - before.slope) / (2 * h), at.bend, 1e-6 * (1.0 + std::abs(at.bend)));
      EXPECT_LT(at.slope, 0.0);
    }
    EXPECT_EQ(potential(law, 0.1).slope, 0.0);
    EXPECT_EQ(potential(law, 0.2).value, 0.0);
  }
}

}  // namespace
}  // namespace tendril::contact
