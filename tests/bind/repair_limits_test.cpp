// Repair makes nothing worse by inspect's own counts, whatever it is given.

#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/import.h>
#include <tendril/bind/repair.h>

#include <random>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;

PolygonMesh read_case(const std::string& name) {
  return read_mesh(std::string(TENDRIL_SOURCE_DIR) + "/tests/data/cases/" + name);
}

void expect_no_worse(const MeshReport& now, const MeshReport& before) {
  EXPECT_LE(now.duplicate_points.size(), before.duplicate_points.size());
  EXPECT_LE(now.isolated_points.size(), before.isolated_points.size());
  EXPECT_LE(now.degenerate_faces.size(), before.degenerate_faces.size());
  EXPECT_LE(now.duplicate_faces.size(), before.duplicate_faces.size());
  EXPECT_LE(now.non_manifold_edges.size(), before.non_manifold_edges.size());
  EXPECT_LE(now.non_manifold_points.size(), before.non_manifold_points.size());
  EXPECT_LE(now.inconsistent_edges.size(), before.inconsistent_edges.size());
  EXPECT_LE(now.boundary_loops, before.boundary_loops);
  EXPECT_LE(now.inside_out, before.inside_out);
}

TEST(RepairLimits, KeepsPartsApartThatTouchInAPoint) {
  const PolygonMesh mesh = read_case("meshes/repair_pinch.off");
  const Repaired repaired = repair(mesh);
  EXPECT_FALSE(repaired.changed());
  EXPECT_EQ(repaired.left.duplicate_points.size(), 1U);
  EXPECT_TRUE(repaired.left.is_manifold());
}

TEST(RepairLimits, MergesTheSeamsBesideAPointThatStaysApart) {
  // Two tetrahedra as loose triangles, one point in common: their seams close, the common point is not one.
  const PolygonMesh whole = read_case("meshes/repair_pinch.off");
  PolygonMesh loose;
  for (std::size_t f = 0; f < whole.face_count(); ++f)
    for (const std::uint32_t i : whole.face(f)) {
      loose.corners.push_back(static_cast<std::uint32_t>(loose.points.size()));
      loose.points.push_back(whole.points[i]);
      if (loose.corners.size() % 3 == 0)
        loose.face_begin.push_back(static_cast<std::uint32_t>(loose.corners.size()));
    }
  const Repaired repaired = repair(loose);
  EXPECT_TRUE(repaired.left.is_manifold());
  EXPECT_LT(repaired.left.boundary_loops, inspect(loose).boundary_loops);
}

TEST(RepairLimits, KeepsAFaceWhoseLossWouldOpenTheSurface) {
  // A tetrahedron with a point on one edge: the sliver between is without area, but closes it.
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}},
                                   {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 1, 4}});
  ASSERT_TRUE(inspect(mesh).is_closed());
  ASSERT_EQ(inspect(mesh).degenerate_faces.size(), 1U);
  const Repaired repaired = repair(mesh);
  EXPECT_TRUE(repaired.left.is_closed());
  EXPECT_EQ(repaired.left.degenerate_faces.size(), 1U);
}

TEST(RepairLimits, TurnsAnInwardFaceOutward) {
  const PolygonMesh turned = read_case("inside_out/one_turned.off");
  // Five of the cube's faces look inward.
  EXPECT_EQ(repair(turned).turned, (Ids{1, 2, 3, 4, 5}));
  EXPECT_EQ(repair(turned).left.inside_out, 0U);
  const PolygonMesh flipped = read_case("inside_out/flipped.off");
  EXPECT_EQ(inspect(flipped).inside_out, 1U);
  const Repaired repaired = repair(flipped);
  EXPECT_EQ(repaired.turned.size(), flipped.face_count());
  EXPECT_EQ(repaired.left.inside_out, 0U);
}

TEST(RepairLimits, LeavesACavityAsItIs) {
  PolygonMesh mesh =
      mesh_of({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}},
              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {4, 5, 6}, {4, 7, 5}, {5, 7, 6}, {6, 7, 4}});
  EXPECT_EQ(inspect(mesh).inside_out, 0U);
  EXPECT_FALSE(repair(mesh).changed());
}

/// Inside out as a whole, a body with a cavity is turned as a whole, and one with a kernel is, too.
TEST(RepairLimits, TurnsACavityWithTheBodyAroundIt) {
  const std::vector<Vec3> points{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9},
                                 {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
  const std::vector<Ids> body{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
      cavity{{4, 5, 6}, {4, 7, 5}, {5, 7, 6}, {6, 7, 4}};
  for (const bool hollow : {true, false}) {
    std::vector<Ids> faces;
    for (Ids face : body) faces.push_back({face[0], face[2], face[1]});
    for (Ids face : cavity) faces.push_back(hollow ? Ids{face[0], face[2], face[1]} : face);
    const Repaired repaired = repair(mesh_of(points, faces));
    EXPECT_EQ(repaired.turned, (Ids{0, 1, 2, 3, 4, 5, 6, 7})) << hollow;
    EXPECT_EQ(repaired.left.inside_out, 0U);
  }
}

TEST(RepairLimits, MergesWithinADistance) {
  PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1e-12, 0}, {1, 1, 0}, {1e-12, 1, 0}},
                             {{0, 1, 2}, {3, 4, 5}});
  EXPECT_EQ(repair(mesh).mesh.points.size(), 6U);
  const Repaired near = repair(mesh, {.merge_distance = 1e-9});
  EXPECT_EQ(near.mesh.points.size(), 4U);
  EXPECT_EQ(near.left.edges, 5U);
  for (const double wrong : {-1.0, 0.02, std::nan("")})
    EXPECT_THROW(repair(mesh, {.merge_distance = wrong}), InvalidInput);
}

/// A closed box of 12 triangles, or a sheet, damaged at random: points split, corners swapped, faces turned,
/// doubled, dropped, with a point twice, slivers over edges, parts that touch.
PolygonMesh damaged(std::mt19937& random) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<Ids> box{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                             {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  std::vector<Vec3> points;
  std::vector<Ids> faces;
  const std::size_t boxes = 1 + random() % 3;
  for (std::size_t b = 0; b < boxes; ++b) {
    const Vec3 shift(static_cast<double>(random() % 2), static_cast<double>(random() % 2), 0);
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Vec3& p : corners) points.push_back(p + static_cast<double>(b) * shift);
    for (Ids face : box) {
      for (std::uint32_t& i : face) i += first;
      faces.push_back(face);
    }
  }
  for (std::size_t k = 1 + random() % 6; k > 0; --k) {
    Ids face = faces[random() % faces.size()];
    switch (random() % 6) {
      case 0:
        faces.push_back(face);
        break;
      case 1:
        std::reverse(face.begin(), face.end());
        faces.push_back(face);
        break;
      case 2:
        faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(random() % faces.size()));
        break;
      case 3:
        faces.push_back({face[0], face[1], face[0]});
        break;
      case 4: {
        Ids& one = faces[random() % faces.size()];
        points.push_back(points[one[0]]);
        one[0] = static_cast<std::uint32_t>(points.size() - 1);
        break;
      }
      default: {
        points.push_back(0.5 * (points[face[0]] + points[face[1]]));
        faces.push_back({face[1], face[0], static_cast<std::uint32_t>(points.size() - 1)});
      }
    }
  }
  return mesh_of(points, faces);
}

TEST(RepairLimits, MakesNoCountOfInspectionGrow) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 10000 && !testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE(trial);
    const PolygonMesh mesh = damaged(random);
    const Repaired repaired = repair(mesh);
    expect_no_worse(inspect(repaired.mesh), inspect(mesh));
    require_valid(repaired.mesh);
  }
}

}  // namespace
}  // namespace tendril::bind
