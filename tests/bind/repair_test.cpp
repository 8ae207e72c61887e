#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/repair.h>

#include <random>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;

/// A torus of m x n squares, split in triangles.
PolygonMesh torus(std::uint32_t m, std::uint32_t n) {
  std::vector<Vec3> points;
  std::vector<Ids> faces;
  for (std::uint32_t i = 0; i < m; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * M_PI * i / m, v = 2 * M_PI * j / n;
      points.emplace_back((2 + std::cos(v)) * std::cos(u), (2 + std::cos(v)) * std::sin(u), std::sin(v));
      const std::uint32_t a = i * n + j, b = (i + 1) % m * n + j, c = (i + 1) % m * n + (j + 1) % n,
                          d = i * n + (j + 1) % n;
      faces.push_back({a, b, c});
      faces.push_back({a, c, d});
    }
  return mesh_of(points, faces);
}

/// Every corner a point of its own, some faces turned over, twice there, or without area; points in no face.
PolygonMesh shattered(const PolygonMesh& mesh, std::mt19937& random) {
  PolygonMesh out;
  const auto add = [&](Ids face) {
    for (const std::uint32_t corner : face) {
      out.corners.push_back(static_cast<std::uint32_t>(out.points.size()));
      out.points.push_back(mesh.points[corner]);
    }
    out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
  };
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    Ids face(mesh.face(f).begin(), mesh.face(f).end());
    if (random() % 3 == 0) std::reverse(face.begin(), face.end());
    add(face);
    if (random() % 5 == 0) add(face);
    if (random() % 5 == 0) add({face[0], face[1], face[0]});
    if (random() % 5 == 0) out.points.emplace_back(9, 9, static_cast<double>(f));
  }
  return out;
}

TEST(Repair, ChangesNothingWhereNothingIsOdd) {
  const PolygonMesh mesh = torus(8, 5);
  const Repaired repaired = repair(mesh);
  EXPECT_FALSE(repaired.changed());
  expect_same(repaired.mesh, mesh);
}

/// Of what merging shortens and turning reverses, the corners that stay keep theirs.
TEST(Repair, KeepsTextureCoordinates) {
  // Point 4 is where point 1 is, point 5 in no face; the second face is turned.
  PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {7, 7, 7}, {1, 1, 1}},
                             {{0, 1, 4, 2, 3}, {1, 2, 6}, {0, 1, 1}});
  for (std::size_t i = 0; i < 7; ++i) mesh.point_texture.push_back({static_cast<double>(i), 0.5});
  for (std::size_t c = 0; c < 11; ++c) mesh.corner_texture.push_back({0.5, static_cast<double>(c)});
  const PolygonMesh even = repair(mesh).mesh;
  require_valid(even);
  ASSERT_EQ(even.corners, (Ids{0, 1, 2, 3, 1, 4, 2}));
  std::vector<double> points, corners;
  for (const TextureCoordinate& at : even.point_texture) points.push_back(at[0]);
  for (const TextureCoordinate& at : even.corner_texture) corners.push_back(at[1]);
  EXPECT_EQ(points, (std::vector<double>{0, 1, 2, 3, 6}));
  EXPECT_EQ(corners, (std::vector<double>{0, 1, 3, 4, 5, 7, 6}));
}

TEST(Repair, PutsAShatteredTorusTogether) {
  std::mt19937 random(5);
  const PolygonMesh whole = torus(12, 7);
  for (int trial = 0; trial < 20; ++trial) {
    const PolygonMesh pieces = shattered(whole, random);
    const Repaired repaired = repair(pieces);
    const MeshReport report = inspect(repaired.mesh);
    EXPECT_EQ(report.points, whole.points.size());
    EXPECT_EQ(report.faces, whole.face_count());
    EXPECT_EQ(report.euler_characteristic, 0);
    EXPECT_TRUE(report.is_closed() && report.is_manifold() && report.is_oriented());
    EXPECT_TRUE(report.degenerate_faces.empty() && report.isolated_points.empty());
    EXPECT_TRUE(repaired.one_sided.empty());
    ASSERT_EQ(repaired.point.size(), pieces.points.size());
    for (std::size_t i = 0; i < pieces.points.size(); ++i)
      if (repaired.point[i] != kDropped)
        EXPECT_EQ(repaired.mesh.points[repaired.point[i]], pieces.points[i]) << i;
    for (std::size_t f = 0; f < pieces.face_count(); ++f) {
      if (repaired.face[f] == kDropped) continue;
      Ids now(repaired.mesh.face(repaired.face[f]).begin(), repaired.mesh.face(repaired.face[f]).end());
      Ids before;
      for (const std::uint32_t corner : pieces.face(f)) before.push_back(repaired.point[corner]);
      const bool turned = std::count(repaired.turned.begin(), repaired.turned.end(), repaired.face[f]) > 0;
      if (turned) std::reverse(before.begin() + 1, before.end());
      EXPECT_EQ(now, before) << f;
    }
  }
}

TEST(Repair, TurnsTheFewerFacesAndTheNormalsOfPointsThatTurnedWhole) {
  PolygonMesh mesh = torus(6, 5);
  mesh.point_normals.assign(mesh.points.size(), Vec3::UnitZ());
  std::swap(mesh.corners[1], mesh.corners[2]);
  const Repaired one = repair(mesh);
  EXPECT_EQ(one.turned, Ids{0});
  EXPECT_EQ(one.mesh.point_normals, mesh.point_normals);
  for (std::size_t f = 1; f < mesh.face_count(); ++f)
    std::swap(mesh.corners[3 * f + 1], mesh.corners[3 * f + 2]);
  std::swap(mesh.corners[4], mesh.corners[5]);  // one face alone agrees with what the mesh was
  // Fewer or not: what is closed shall look outward.
  EXPECT_EQ(repair(mesh).turned.size(), mesh.face_count() - 1);
  EXPECT_EQ(inspect(repair(mesh).mesh).inside_out, 0U);
  PolygonMesh part = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 0, 0}, {3, 0, 0}},
                             {{0, 1, 2}, {1, 2, 3}, {3, 1, 4}});
  part.point_normals.assign(6, Vec3::UnitZ());
  const Repaired turned = repair(part);
  EXPECT_EQ(turned.turned, Ids{1});
  EXPECT_EQ(turned.mesh.point_normals.size(), 5U);
}

TEST(Repair, SaysWhereASurfaceHasOneSideOnly) {
  // Five triangles of a Moebius band: triangle i joins the points i, i + 1, i + 2 modulo 5.
  std::vector<Ids> faces;
  for (std::uint32_t i = 0; i < 5; ++i) faces.push_back({i, (i + 1) % 5, (i + 2) % 5});
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i) points.emplace_back(std::cos(i * 1.3), std::sin(i * 1.3), i * i % 3);
  const Repaired repaired = repair(mesh_of(points, faces));
  EXPECT_EQ(repaired.one_sided.size(), 1U);
  EXPECT_FALSE(inspect(repaired.mesh).is_oriented());
}

TEST(Repair, ShortensFacesWhoseCornersMergeAndDropsWhatIsLeftOfTwo) {
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, -0.0, 0}},
                                   {{0, 1, 2, 3}, {4, 0, 2}, {2, 1, 0}});
  const Repaired repaired = repair(mesh, {.drop_duplicates = false});
  EXPECT_EQ(repaired.shortened, Ids{0});
  EXPECT_EQ(repaired.face, (Ids{0, kDropped, 1}));
  EXPECT_EQ(repaired.point, (Ids{0, 1, 2, 2, 0}));
  EXPECT_EQ(repair(mesh).face, (Ids{0, kDropped, kDropped}));
}

TEST(Repair, DoesWhatIsAskedOnly) {
  std::mt19937 random(6);
  PolygonMesh pieces = shattered(torus(5, 4), random);
  pieces.face_colors.assign(pieces.face_count(), Color{1, 2, 3, 4});
  const RepairOptions none{false, false, false, false, false};
  EXPECT_FALSE(repair(pieces, none).changed());
  expect_same(repair(pieces, none).mesh, pieces);
  RepairOptions isolated = none;
  isolated.drop_isolated = true;
  const Repaired repaired = repair(pieces, isolated);
  EXPECT_EQ(repaired.mesh.face_colors, pieces.face_colors);
  EXPECT_EQ(inspect(repaired.mesh).duplicate_points.size(), inspect(pieces).duplicate_points.size());
  EXPECT_TRUE(inspect(repaired.mesh).isolated_points.empty());
  PolygonMesh wrong = pieces;
  wrong.corners[0] = 1u << 30;
  EXPECT_THROW(repair(wrong), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
