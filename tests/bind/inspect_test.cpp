#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/inspect.h>

#include <random>
#include <set>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;
using Edges = std::vector<Edge>;
using Duplicates = std::vector<Duplicate>;

void expect_no_defects(const MeshReport& report) {
  EXPECT_EQ(report.duplicate_points, Duplicates{});
  EXPECT_EQ(report.isolated_points, Ids{});
  EXPECT_EQ(report.degenerate_faces, Ids{});
  EXPECT_EQ(report.duplicate_faces, Duplicates{});
  EXPECT_EQ(report.inconsistent_edges, Edges{});
  EXPECT_TRUE(report.is_manifold());
}

/// m x n squares over [0, m] x [0, n], points row by row.
PolygonMesh sheet(std::uint32_t m, std::uint32_t n) {
  std::vector<Vec3> points;
  std::vector<Ids> faces;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= m; ++i) points.emplace_back(i, j, 0.0);
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < m; ++i) {
      const std::uint32_t p = j * (m + 1) + i;
      faces.push_back({p, p + 1, p + m + 2, p + m + 1});
    }
  }
  return mesh_of(points, faces);
}

void remove_face(PolygonMesh& mesh, std::size_t f) {
  const std::uint32_t begin = mesh.face_begin[f], degree = mesh.face_begin[f + 1] - begin;
  mesh.corners.erase(mesh.corners.begin() + begin, mesh.corners.begin() + begin + degree);
  mesh.face_begin.erase(mesh.face_begin.begin() + static_cast<std::ptrdiff_t>(f));
  for (std::size_t g = f; g < mesh.face_begin.size(); ++g) {
    if (mesh.face_begin[g] > begin) mesh.face_begin[g] -= degree;
  }
}

void add_face(PolygonMesh& mesh, const Ids& face) {
  mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
  mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

TEST(Inspect, Tetrahedron) {
  const MeshReport report = inspect(tetrahedron());
  expect_no_defects(report);
  EXPECT_EQ(report.points, 4);
  EXPECT_EQ(report.faces, 4);
  EXPECT_EQ(report.triangles, 4);
  EXPECT_EQ(report.largest_degree, 3);
  EXPECT_EQ(report.low, Vec3(0, 0, 0));
  EXPECT_EQ(report.high, Vec3(1, 1, 1));
  EXPECT_EQ(report.edges, 6);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.boundary_loops, 0);
  EXPECT_EQ(report.components, 1);
  EXPECT_EQ(report.euler_characteristic, 2);
}

TEST(Inspect, EmptyAndPointsOnly) {
  EXPECT_EQ(inspect(PolygonMesh{}).components, 0);
  const MeshReport report = inspect(mesh_of({{1, 2, 3}, {-1, 5, 0}}, {}));
  EXPECT_EQ(report.isolated_points, (Ids{0, 1}));
  EXPECT_EQ(report.low, Vec3(-1, 2, 0));
  EXPECT_EQ(report.high, Vec3(1, 5, 3));
  EXPECT_EQ(report.euler_characteristic, 0);
}

TEST(Inspect, OpenSheetWithHoles) {
  PolygonMesh mesh = sheet(5, 4);
  MeshReport report = inspect(mesh);
  expect_no_defects(report);
  EXPECT_EQ(report.triangles, 0);
  EXPECT_EQ(report.largest_degree, 4);
  EXPECT_EQ(report.boundary_edges, 18);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.euler_characteristic, 1);

  // Two squares that touch in a point: two holes, and a point with two fans.
  remove_face(mesh, 12);
  remove_face(mesh, 6);
  report = inspect(mesh);
  EXPECT_EQ(report.boundary_edges, 26);
  EXPECT_EQ(report.non_manifold_points, Ids{14});
  EXPECT_EQ(report.boundary_loops, 2);
}

TEST(Inspect, Torus) {
  std::vector<Vec3> points;
  std::vector<Ids> faces;
  for (std::uint32_t i = 0; i < 15; ++i) {
    const double a = 2 * M_PI * (i / 3) / 5, b = 2 * M_PI * (i % 3) / 3;
    points.emplace_back((3 + std::cos(b)) * std::cos(a), (3 + std::cos(b)) * std::sin(a), std::sin(b));
    const auto id = [](std::uint32_t j, std::uint32_t k) { return j % 5 * 3 + k % 3; };
    faces.push_back({id(i / 3, i % 3), id(i / 3 + 1, i % 3), id(i / 3 + 1, i % 3 + 1), id(i / 3, i % 3 + 1)});
  }
  const MeshReport report = inspect(mesh_of(points, faces));
  expect_no_defects(report);
  EXPECT_TRUE(report.is_closed());
  EXPECT_EQ(report.euler_characteristic, 0);
}

TEST(Inspect, TwoComponentsAndIsolatedPoints) {
  PolygonMesh mesh = tetrahedron();
  for (const double x : {10.0, 11.0, 12.0, 13.0}) mesh.points.emplace_back(x, x * x, 0.0);
  add_face(mesh, {7, 4, 6});
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.isolated_points, Ids{5});
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.euler_characteristic, 3);
}

TEST(Inspect, NonManifoldEdgeAndPoint) {
  PolygonMesh mesh = tetrahedron();
  mesh.points.emplace_back(5, 5, 5);
  add_face(mesh, {3, 1, 4});
  MeshReport report = inspect(mesh);
  EXPECT_EQ(report.non_manifold_edges, (Edges{{1, 3}}));
  EXPECT_EQ(report.non_manifold_points, (Ids{1, 3}));
  EXPECT_EQ(report.inconsistent_edges, Edges{});
  EXPECT_EQ(report.boundary_edges, 2);
  EXPECT_FALSE(report.is_manifold());
  // The same with the face too many in front.
  std::rotate(mesh.corners.begin(), mesh.corners.end() - 3, mesh.corners.end());
  EXPECT_EQ(inspect(mesh).non_manifold_points, (Ids{1, 3}));

  mesh = tetrahedron();
  mesh.points.insert(mesh.points.end(), {{5, 5, 5}, {6, 5, 5}});
  add_face(mesh, {2, 4, 5});
  report = inspect(mesh);
  EXPECT_EQ(report.non_manifold_edges, Edges{});
  EXPECT_EQ(report.non_manifold_points, Ids{2});
  EXPECT_EQ(report.components, 1);
}

TEST(Inspect, InconsistentOrientation) {
  PolygonMesh mesh = tetrahedron();
  std::swap(mesh.corners[4], mesh.corners[5]);  // the face 0 1 3, now 0 3 1
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.inconsistent_edges, (Edges{{0, 1}, {0, 3}, {1, 3}}));
  EXPECT_FALSE(report.is_oriented());
  EXPECT_TRUE(report.is_manifold());
  EXPECT_TRUE(report.is_closed());
}

TEST(Inspect, MoebiusStripHasOneBoundary) {
  std::vector<Vec3> points;
  std::vector<Ids> faces;
  for (std::uint32_t i = 0; i < 5; ++i) {
    points.insert(points.end(), {{std::cos(i), std::sin(i), 0.0}, {std::cos(i), std::sin(i), 1.0}});
    const std::uint32_t p = 2 * i, q = i < 4 ? p + 2 : 1, r = i < 4 ? p + 3 : 0;
    faces.push_back({p, q, r, p + 1});
  }
  const MeshReport report = inspect(mesh_of(points, faces));
  EXPECT_EQ(report.boundary_edges, 10);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.euler_characteristic, 0);
  EXPECT_EQ(report.inconsistent_edges, (Edges{{0, 1}}));
}

TEST(Inspect, DuplicatePointsAndFaces) {
  PolygonMesh mesh = tetrahedron();
  mesh.points.insert(mesh.points.end(), {{1, 0, 0}, {-0.0, 0, 0}, {1, 0, 1e-300}, {1, 0, 0}});
  for (const Ids& face : {Ids{1, 2, 3}, Ids{3, 2, 1}, Ids{4, 2, 3}, Ids{1, 3, 0}}) add_face(mesh, face);
  const MeshReport report = inspect(mesh);
  EXPECT_EQ(report.duplicate_points, (Duplicates{{4, 1}, {5, 0}, {7, 1}}));
  EXPECT_EQ(report.duplicate_faces, (Duplicates{{4, 2}, {5, 2}, {7, 1}}));
}

TEST(Inspect, DegenerateFaces) {
  for (const double scale : {1.0, 1e300, 1e-300}) {
    PolygonMesh mesh = tetrahedron();
    mesh.points.insert(mesh.points.end(), {{3, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}});
    mesh.points.emplace_back(1, 1e-9, 0);
    for (Vec3& p : mesh.points) p *= scale;
    for (const Ids& face :
         {Ids{0, 1, 4}, Ids{5, 6, 7}, Ids{1, 1, 2}, Ids{0, 1, 2, 1}, Ids{0, 4, 8}, Ids{2, 2, 2}}) {
      add_face(mesh, face);
    }
    EXPECT_EQ(inspect(mesh).degenerate_faces, (Ids{4, 5, 6, 7, 9})) << scale;
  }
}

/// Rounding leaves such triangles an area that is not exactly zero.
TEST(Inspect, FindsFacesThatAreFlatUpToRounding) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  PolygonMesh mesh;
  for (std::uint32_t f = 0; f < 200; ++f) {
    const Vec3 direction{uniform(random), uniform(random), uniform(random)};
    for (int k = 0; k < 3; ++k) mesh.points.push_back(uniform(random) * direction);
    add_face(mesh, {3 * f, 3 * f + 1, 3 * f + 2});
  }
  EXPECT_EQ(inspect(mesh).degenerate_faces.size(), 200);
}

TEST(Inspect, ReportsTheFirstOfManyEqualPoints) {
  const MeshReport report = inspect(mesh_of(std::vector<Vec3>(1000, Vec3(1, 2, 3)), {}));
  ASSERT_EQ(report.duplicate_points.size(), 999);
  for (std::uint32_t i = 0; i < 999; ++i) EXPECT_EQ(report.duplicate_points[i], (Duplicate{i + 1, 0}));
}

TEST(Inspect, ARepeatedPointMakesNoEdgeAndNoFan) {
  const MeshReport report = inspect(mesh_of(tetrahedron().points, {{0, 1, 2, 2}, {3, 2, 1, 3}}));
  EXPECT_EQ(report.edges, 5);
  EXPECT_EQ(report.non_manifold_points, Ids{});
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.degenerate_faces, (Ids{0, 1}));
}

/// Counts of each undirected edge's uses, by an ordered map.
TEST(Inspect, AgreesWithCountingOnRandomSoups) {
  std::mt19937 random(11);
  for (int round = 0; round < 200; ++round) {
    PolygonMesh mesh = mesh_of({}, {});
    for (int v = 0; v < 9; ++v) {
      const auto x = static_cast<double>(random() % 3);
      const auto y = static_cast<double>(random() % 3);
      mesh.points.emplace_back(x, y, random() % 2);
    }
    std::multiset<Edge> uses;
    for (int f = 0; f < 8; ++f) {
      Ids face;
      for (int k = 0; k < 3 + f % 2; ++k) face.push_back(static_cast<std::uint32_t>(random() % 9));
      add_face(mesh, face);
      for (std::size_t k = 0; k < face.size(); ++k) {
        const auto [low, high] = std::minmax(face[k], face[(k + 1) % face.size()]);
        if (low != high) uses.insert({low, high});
      }
    }
    const MeshReport report = inspect(mesh);
    std::size_t boundary = 0;
    Edges crowded;
    const std::set<Edge> edges(uses.begin(), uses.end());
    for (const Edge& edge : edges) {
      boundary += uses.count(edge) == 1;
      if (uses.count(edge) > 2) crowded.push_back(edge);
    }
    EXPECT_EQ(report.edges, edges.size());
    EXPECT_EQ(report.boundary_edges, boundary);
    EXPECT_EQ(report.non_manifold_edges, crowded);
  }
}

TEST(Inspect, RefusesWhatIsNoMesh) {
  PolygonMesh mesh = tetrahedron();
  mesh.points[1].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(inspect(mesh), InvalidInput);
  mesh = tetrahedron();
  mesh.corners[0] = 4;
  EXPECT_THROW(inspect(mesh), InvalidInput);
  mesh = tetrahedron();
  mesh.corners.pop_back();  // a face of two
  --mesh.face_begin.back();
  EXPECT_THROW(inspect(mesh), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
