// Closed meshes as they come: inside out, of needles, of quads about points of valence 2, of parts that
// touch.

#include <gtest/gtest.h>
#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>
#include <tendril/bind/import.h>

#include <cmath>

#include "axis/shapes.h"

namespace tendril::test {
namespace {

bind::PolygonMesh read_case(const std::string& name) {
  return bind::read_mesh(std::string(TENDRIL_SOURCE_DIR) + "/tests/data/cases/" + name);
}

/// How much of the way along z, of a mesh's length there, its first curve takes; and how far off x = y = 0.
struct Reach {
  double from = 1e300, to = -1e300, off = 0.0;
};
Reach reach_of(const axis::AxisCurve& curve) {
  Reach reach;
  for (const Vec3& p : curve.points) {
    reach.from = std::min(reach.from, p.z());
    reach.to = std::max(reach.to, p.z());
    reach.off = std::max(reach.off, p.head<2>().norm());
  }
  return reach;
}

Eigen::Index longest_axis(const bind::PolygonMesh& mesh) {
  Vec3 low = mesh.points[0], high = low;
  for (const Vec3& p : mesh.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

/// With the longest axis along z.
bind::PolygonMesh upright(bind::PolygonMesh mesh) {
  const Eigen::Index axis = longest_axis(mesh);
  for (Vec3& p : mesh.points) p = Vec3(p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]);
  return mesh;
}

axis::AxisOptions options(bool close, bool largest_part) {
  axis::AxisOptions how;
  how.close = close;
  how.largest_part = largest_part;
  how.time_limit = 1e-9;  // what matters here comes before the contraction
  return how;
}

TEST(AxisOfOddMeshes, RunsThroughACylinderWithPointsOnItsLidsOnly) {
  const bind::PolygonMesh mesh = upright(read_case("lids_only/cylinder_L15.off"));
  double low = 1e300, high = -1e300;
  for (const Vec3& p : mesh.points) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  const axis::AxisTree tree = axis::find_axis(mesh, {});
  ASSERT_EQ(tree.status, axis::AxisStatus::found) << tree.reason;
  ASSERT_EQ(tree.curves.size(), 1U);
  const Reach reach = reach_of(tree.curves[0]);
  // Nearer to either lid than the radius the middle of the body is no line.
  EXPECT_GE(reach.to - reach.from, 0.95 * (high - low - 1.0));
  EXPECT_LE(reach.off, 0.05);
}

/// The one curve's, of a cylinder of length 10 along z.
Reach reach_in_cylinder(double radius, std::uint32_t rings, std::uint32_t round) {
  const axis::AxisTree tree = axis::find_axis(cylinder(10.0, radius, rings, round), {});
  EXPECT_EQ(tree.status, axis::AxisStatus::found) << tree.reason;
  EXPECT_EQ(tree.curves.size(), 1U);
  return reach_of(tree.curves.at(0));
}

/// Of triangles far finer round than along, and finer than the flow's own edges: without even ones in their
/// stead the axis turned back at both ends, 0.6 radii off.
TEST(AxisOfOddMeshes, RunsThroughACylinderOfTrianglesThatAreTooFine) {
  const Reach reach = reach_in_cylinder(0.5, 60, 300);
  EXPECT_GE(reach.to - reach.from, 0.95 * 9.0);
  EXPECT_LE(reach.off, 0.025);
}

/// Their flow ends long before the lids, or runs to one side: 71 % of the way, and 0.1 radii off, without
/// what comes after it.
TEST(AxisOfOddMeshes, RunsThroughThickAndThinCylinders) {
  const Reach thick = reach_in_cylinder(2.0, 40, 60), thin = reach_in_cylinder(0.2, 50, 12);
  EXPECT_GE(thick.to - thick.from, 0.99 * 6.0);
  EXPECT_LE(thick.off, 0.01 * 2.0);
  EXPECT_GE(thin.to - thin.from, 0.99 * 9.6);
  EXPECT_LE(thin.off, 0.02 * 0.2);
}

TEST(AxisOfOddMeshes, IsThatOfTheTurnedMesh) {
  const bind::PolygonMesh flipped = upright(read_case("inside_out/flipped.off"));
  const axis::AxisTree tree = axis::find_axis(flipped, {});
  EXPECT_TRUE(tree.report.turned);
  ASSERT_EQ(tree.curves.size(), 1U);
  const Reach reach = reach_of(tree.curves[0]);
  EXPECT_NEAR(reach.from, 0.6, 0.15);
  EXPECT_NEAR(reach.to, 9.5, 0.25);
}

TEST(AxisOfOddMeshes, TriangulatesWithoutAnEdgeMetTwice) {
  try {
    axis::find_axis(read_case("meshes/fan_nonmanifold.off"), options(false, false));
  } catch (const InvalidInput& error) {
    EXPECT_EQ(std::string(error.what()).find("non-manifold"), std::string::npos) << error.what();
  }
}

TEST(AxisOfOddMeshes, TakesOneOfTwoPartsThatTouchInAPoint) {
  const bind::PolygonMesh mesh = read_case("meshes/pinch_largest.off");
  EXPECT_THROW(axis::find_axis(mesh, {}), InvalidInput);
  const axis::AxisTree tree = axis::find_axis(mesh, options(false, true));
  EXPECT_EQ(tree.report.left_out_parts, 1U);
}

TEST(AxisOfOddMeshes, RefusesWhatIsFlat) {
  bind::PolygonMesh sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.corners = {0, 1, 2, 0, 2, 3};
  sheet.face_begin = {0, 3, 6};
  try {
    axis::find_axis(sheet, options(true, false));
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("no volume"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tendril::test
