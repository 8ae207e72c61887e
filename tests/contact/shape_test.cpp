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

/// A prism over an L: z in [-0.5, 0.5] over [-0.5, 0.5]^2 less x > 0 and y > 0. Its inner edge is hollow.
ShapePtr prism() {
  std::vector<Vec3> points;
  for (const double z : {-0.5, 0.5})
    for (const auto& [x, y] :
         {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.0}, {0.0, 0.0}, {0.0, 0.5}, {-0.5, 0.5}})
      points.emplace_back(x, y, z);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    triangles.push_back({i, next, next + 6});
    triangles.push_back({i, next + 6, i + 6});
  }
  for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}, {0u, 3u, 4u}, {0u, 4u, 5u}}) {
    triangles.push_back({a, c, b});
    triangles.push_back({a + 6, b + 6, c + 6});
  }
  return mesh(points, triangles);
}

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
          {"prism", prism(),
           [](const Vec3& x) { return x.cwiseAbs().maxCoeff() <= 0.5 && !(x.x() > 0.0 && x.y() > 0.0); }},
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

/// A tetrahedron, and what may be wrong with it.
TEST(Shapes, RefuseMeshesThatEncloseNothing) {
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Triangles good{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const auto place_of = [](const std::vector<Vec3>& p, const Triangles& t) {
    try {
      mesh(p, t);
    } catch (const InvalidInput& error) {
      return error.place() + ": " + error.reason();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(place_of(points, good), "accepted");
  Triangles open(good.begin(), good.end() - 1), turned = good, out_of_range = good, inside_out;
  std::swap(turned[2][0], turned[2][1]);
  out_of_range[1][2] = 7;
  for (const auto& [a, b, c] : good) inside_out.push_back({a, c, b});
  EXPECT_EQ(place_of(points, open), "mesh.triangles[0]: an edge of no other triangle");
  EXPECT_EQ(place_of(points, turned),
            "mesh.triangles[2]: an edge that another triangle has in the same direction");
  EXPECT_EQ(place_of(points, out_of_range), "mesh.triangles[1]: 7");
  EXPECT_EQ(place_of(points, inside_out), "mesh.triangles: inside out");
  EXPECT_EQ(place_of(points, {}), "mesh.triangles: none");
  std::vector<Vec3> flat = points, lost = points, two = points;
  flat[3] = Vec3(0.5, 0, 0);
  lost[1].x() = std::nan("");
  EXPECT_EQ(place_of(flat, good), "mesh.triangles[1]: three corners on a line");
  EXPECT_EQ(place_of(lost, good), "mesh.points: not finite");
  // Two that meet at a point.
  Triangles both = good;
  for (const Vec3& p : points) two.emplace_back(-p);
  const auto mirrored = [](std::uint32_t i) { return i == 0 ? 0 : i + 4; };
  for (const auto& [a, b, c] : inside_out) both.push_back({mirrored(a), mirrored(b), mirrored(c)});
  EXPECT_EQ(place_of(two, both), "mesh.points[0]: two parts of the surface meet there");
}

}  // namespace
}  // namespace tendril::contact
