#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/distortion.h>

#include <Eigen/SVD>

#include "support/pairs.h"
#include "support/random.h"

namespace tendril::bind {
namespace {

/// A strip in the plane z = 0 along x, `count` quads long and one wide, bound to an axis along its middle.
struct Strip {
  PolygonMesh mesh;
  std::vector<CurvePair> rest;

  explicit Strip(int count) {
    for (int i = 0; i <= count; ++i)
      for (const double y : {-0.5, 0.5}) mesh.points.emplace_back(i, y, 0.0);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
      mesh.corners.insert(mesh.corners.end(), {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
      mesh.face_begin.push_back(4 * (i + 1));
    }
    std::vector<Vec3> p;
    for (int i = 0; i <= count; ++i) p.emplace_back(i, 0, 0);
    rest.push_back(test::pair_through(p, Vec3::UnitY(), 0.3));
  }
  Distortion measure(const std::vector<Vec3>& points, double limit = 10.0) const {
    return measure_distortion(Binding(rest, mesh, {}), rest, mesh, rest, points, limit);
  }
};

TEST(Distortion, IsTheSingularValuesOfALinearMap) {
  const Strip strip(3);
  test::Random random(5);
  for (int k = 0; k < 20; ++k) {
    Mat3 map;
    map << random.in_cube(), random.in_cube(), random.in_cube();
    std::vector<Vec3> points;
    for (const Vec3& p : strip.mesh.points) points.push_back(map * p + Vec3(1, 2, 3));
    const Eigen::JacobiSVD<Eigen::Matrix<double, 3, 2>> svd(map.leftCols<2>());
    const Distortion d = strip.measure(points, 1e6);
    EXPECT_EQ(d.triangles, 6U);
    EXPECT_NEAR(d.most_stretch, std::max(1.0, svd.singularValues()[0]), 1e-12);
    EXPECT_NEAR(d.least_stretch, std::min(1.0, svd.singularValues()[1]), 1e-7);
  }
}

TEST(Distortion, FindsZonesThatFoldStretchOrCollapse) {
  const Strip strip(10);
  std::vector<Vec3> points = strip.mesh.points;
  EXPECT_TRUE(strip.measure(points).zones.empty());
  EXPECT_EQ(strip.measure(points).spoilt, 0.0);
  points[4] = points[2];  // a corner onto the one before: two triangles of no area
  for (int i = 18; i < 22; ++i)
    points[static_cast<std::size_t>(i)].x() = 27.0 - 2 * (i / 2);  // the last quad turned over
  const Distortion d = strip.measure(points);
  EXPECT_EQ(d.folded, 2U);
  EXPECT_GE(d.crushed, 1U);
  ASSERT_EQ(d.zones.size(), 2U);
  EXPECT_GT(d.spoilt, 0.1);
  double area = 0.0;
  for (const SpoiltZone& zone : d.zones) area += zone.area;
  EXPECT_NEAR(area, d.spoilt, 1e-15);
  EXPECT_GE(d.zones[0].area, d.zones[1].area);
  for (const SpoiltZone& zone : d.zones) {
    const bool end = zone.centre.x() > 5.0;
    if (end) {
      EXPECT_EQ(zone.faces, std::vector<std::uint32_t>{9});
    }
    EXPECT_NEAR(zone.centre.x(), end ? 9.5 : 1.5, 0.6);
    EXPECT_LT(zone.radius, 2.0);
  }
  points = strip.mesh.points;
  points[0].x() = -30.0;
  EXPECT_GE(strip.measure(points).stretched, 1U);
  EXPECT_EQ(strip.measure(points).folded, 0U);
  EXPECT_EQ(strip.measure(points, 1e3).zones.size(), 0U);
  EXPECT_THROW(strip.measure(points, 1.0), InvalidInput);
  points.pop_back();
  EXPECT_THROW(strip.measure(points), InvalidInput);
}

TEST(Normals, TurnAsTheSurfaceDoes) {
  Strip strip(4);
  test::Random random(6);
  for (std::size_t i = 0; i < strip.mesh.points.size(); ++i)
    strip.mesh.point_normals.push_back((Vec3::UnitZ() + 0.3 * random.in_cube()).normalized());
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::DiagonalMatrix<double, 3> wider(3.0, 1.0, 1.0);
  std::vector<Vec3> turned, stretched;
  for (const Vec3& p : strip.mesh.points) turned.push_back(turn * p), stretched.push_back(turn * (wider * p));
  const std::vector<Vec3> a = posed_normals(strip.mesh, turned), b = posed_normals(strip.mesh, stretched);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3& n = strip.mesh.point_normals[i];
    EXPECT_LT((a[i] - turn * n).norm(), 1e-14);
    const Vec3 expected =
        (turn * (wider.inverse() * n)).normalized();  // of the plane across it, stretched along x
    EXPECT_LT((b[i] - expected).norm(), 1e-14);
  }
  strip.mesh.point_normals.pop_back();
  EXPECT_THROW(posed_normals(strip.mesh, turned), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
