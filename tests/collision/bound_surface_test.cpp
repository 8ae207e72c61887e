#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/exact/bound_surface.h>

#include <limits>

#include "collision/bound_meshes.h"

namespace tendril::exact {
namespace {

using test::BoundMesh;
using test::Random;
using Pose = std::vector<CurvePair>;

std::vector<std::uint32_t> flat(std::span<const collision::Triangle> triangles) {
  std::vector<std::uint32_t> out;
  for (const collision::Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
  return out;
}

BoundMesh bound_tube(int rings = 24, int around = 16) {
  return {{test::straight_pair(8, 0.05)}, test::tube(rings, around, 0.1)};
}

Pose posed(const BoundMesh& mesh, Random& random) {
  const double bend = random.uniform(-5, 5);
  return {test::shaken(test::bent(mesh.rest[0], bend, random.uniform(-6, 6)), 0.02, random)};
}

/// On the surface to the last bit, near it, and far from it.
Vec3 somewhere(const std::vector<Vec3>& at, Random& random) {
  const Vec3 on = at[static_cast<std::size_t>(random.integer(static_cast<int>(at.size())))];
  return random.integer(4) == 0 ? on : on + random.in_cube(std::exp(random.uniform(-6, 0.5)));
}

void expect_same(const Nearest& a, const Nearest& b) {
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.distance.answer, b.distance.answer);
  EXPECT_EQ(a.distance.lower, b.distance.lower);
  EXPECT_EQ(a.distance.upper, b.distance.upper);
}

/// \return  how many answers were that something meets
int compare(BoundSurface& bound, const Surface& whole, const std::vector<Vec3>& at, Random& random) {
  int met = 0;
  for (int i = 0; i < 25; ++i) {
    const Vec3 x = somewhere(at, random), y = somewhere(at, random), z = somewhere(at, random);
    const double r = 0.2 * (x - y).norm();
    for (const Shape& shape :
         {point(x), segment({x, y}), triangle({x, y, z}), ball(x, r), capsule({x, y}, 0.1 * r)}) {
      EXPECT_EQ(bound.relation(shape), whole.relation(shape));
      EXPECT_EQ(bound.meetings(shape), whole.meetings(shape));
      expect_same(bound.nearest(shape), whole.nearest(shape));
      met += whole.relation(shape).relation != Relation::free;
    }
    EXPECT_EQ(bound.solid_relation(x, r), whole.solid_relation(x, r));
    EXPECT_EQ(bound.inside(x).answer, whole.inside(x).answer);
    EXPECT_NEAR(bound.inside(x).winding, whole.inside(x).winding, 1e-12);
  }
  return met;
}

int compare_in_poses(const BoundMesh& mesh, std::span<const collision::Triangle> triangles) {
  BoundSurface bound(mesh.rest, mesh.points, triangles);
  Random random(1);
  int met = compare(bound, Surface(mesh.at(mesh.rest), flat(triangles)), mesh.at(mesh.rest), random);
  for (int i = 0; i < 12; ++i) {
    const Pose pose = posed(mesh, random);
    bound.pose(pose);
    const std::vector<Vec3> at = mesh.at(pose);
    met += compare(bound, Surface(at, flat(triangles)), at, random);
  }
  return met;
}

TEST(BoundSurface, AnswersAsTheWholeMeshUpdated) {
  const BoundMesh mesh = bound_tube();
  ASSERT_TRUE(BoundSurface(mesh.rest, mesh.points, mesh.triangles).closed());
  EXPECT_GT(compare_in_poses(mesh, mesh.triangles), 500);
}

TEST(BoundSurface, AnswersSoWhereItIsOpen) {
  const BoundMesh mesh = bound_tube();
  const auto open = std::span(mesh.triangles).subspan(5);
  ASSERT_FALSE(BoundSurface(mesh.rest, mesh.points, open).closed());
  EXPECT_GT(compare_in_poses(mesh, open), 500);
}

TEST(BoundSurface, MeetsASurfaceInThePairsOfTheWholeMesh) {
  const BoundMesh mesh = bound_tube();
  BoundSurface bound(mesh.rest, mesh.points, mesh.triangles);
  const bind::PolygonMesh leaf = test::leaf(12, 8);
  Random random(2);
  std::size_t met = 0;
  for (int i = 0; i < 20; ++i) {
    std::vector<Vec3> moved = leaf.points;
    const Vec3 by = random.in_cube(0.6);
    for (Vec3& x : moved) x += by;
    const Surface other(moved, flat(test::triangles_of(leaf)));
    const Pose pose = posed(mesh, random);
    bound.pose(pose);
    const std::vector<Meeting> found = bound.meetings(other);
    EXPECT_EQ(found, Surface(mesh.at(pose), flat(mesh.triangles)).meetings(other));
    met += found.size();
  }
  EXPECT_GT(met, 100U);
}

/// Points that are two in the mesh's arrays and one in space, as where faces have corners of their own.
TEST(BoundSurface, IsClosedWherePointsAreBoundAlike) {
  const bind::PolygonMesh tube = test::tube(12, 8, 0.1);
  bind::PolygonMesh apart;
  for (const std::uint32_t c : tube.corners) apart.points.push_back(tube.points[c]);
  for (std::uint32_t i = 0; i < apart.points.size(); ++i) apart.corners.push_back(i);
  for (std::uint32_t i = 3; i <= apart.points.size(); i += 3) apart.face_begin.push_back(i);
  const BoundMesh mesh{{test::straight_pair(8, 0.05)}, apart};
  BoundSurface bound(mesh.rest, mesh.points, mesh.triangles);
  EXPECT_TRUE(bound.closed());
  bound.pose(Pose{test::bent(mesh.rest[0], 1.0, 0.5)});
  EXPECT_EQ(bound.inside(Vec3(9, 9, 9)).answer, collision::kFree);
  bind::PolygonMesh moved = apart;
  moved.points[0].z() += 1e-6;
  const BoundMesh torn{{test::straight_pair(8, 0.05)}, moved};
  EXPECT_FALSE(BoundSurface(torn.rest, torn.points, torn.triangles).closed());
}

TEST(BoundSurface, DeformsNothingThatIsFar) {
  const BoundMesh mesh = bound_tube(200, 60);
  BoundSurface bound(mesh.rest, mesh.points, mesh.triangles);
  bound.pose(Pose{test::bent(mesh.rest[0], 1.0, 0.5)});
  EXPECT_EQ(bound.relation(ball({0, 0, 9}, 1)), collision::kFree);
  EXPECT_EQ(bound.inside({0, 0, 9}).answer, collision::kFree);
  EXPECT_EQ(bound.work().touched, 0U);
  const Nearest near = bound.nearest(point({0.5, 0.4, 9}));
  EXPECT_GT(near.distance.lower, 8.0);
  EXPECT_GT(bound.work().touched, 0U);
  EXPECT_LT(bound.work().touched, bound.work().cells / 4);
}

TEST(BoundSurface, SaysWhatItCannotAnswer) {
  const BoundMesh mesh = bound_tube();
  BoundSurface bound(mesh.rest, mesh.points, mesh.triangles);
  const Vec3 bad(0, std::numeric_limits<double>::quiet_NaN(), 0);
  const Answer not_finite = undecidable(Reason::not_finite);
  EXPECT_EQ(bound.relation(point(bad)), not_finite);
  EXPECT_EQ(bound.relation(ball({0, 0, 0}, -1)), not_finite);
  EXPECT_EQ(bound.inside(bad).answer, not_finite);
  EXPECT_EQ(bound.nearest(point(bad)).distance.answer, not_finite);
  EXPECT_EQ(bound.solid_relation(bad, 1), not_finite);
  EXPECT_TRUE(bound.meetings(point(bad)).empty());
  EXPECT_EQ(bound.work().touched, 0U);
}

TEST(BoundSurface, RefusesWhatIsNoPose) {
  const BoundMesh mesh = bound_tube();
  BoundSurface bound(mesh.rest, mesh.points, mesh.triangles);
  EXPECT_THROW(bound.pose({}), InvalidInput);
  EXPECT_THROW(bound.pose(Pose{test::with_control_point(mesh.rest[0], 3, Vec3(0x1p201, 0, 0))}),
               InvalidInput);
  EXPECT_EQ(bound.inside({0.5, 0, 0}).answer, collision::kHit);
  EXPECT_THROW(BoundSurface(mesh.rest, mesh.points, {}), InvalidInput);
}

}  // namespace
}  // namespace tendril::exact
