#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>
#include <tendril/bind/inspect.h>

#include <algorithm>
#include <filesystem>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;

/// One of the files holds a face more than its header counts.
constexpr const char* contradictory = "prim.off";

/// The OFF and PLY files of libcgal-demo's folder of meshes, by name, without that one.
std::vector<std::string> mesh_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(TENDRIL_CGAL_MESHES)) {
    const auto ending = entry.path().extension();
    if (entry.path().filename() == contradictory) continue;
    if (ending == ".off" || ending == ".ply") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Largest distance of two points relative to the size of the coordinates.
double largest_difference(const std::vector<Vec3>& points, const std::vector<Point>& reference) {
  double largest = 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Vec3 q(reference[v].x(), reference[v].y(), reference[v].z());
    largest = std::max(largest, (points[v] - q).norm() / std::max(1e-300, q.norm()));
  }
  return largest;
}

bool same_faces(const PolygonMesh& mesh, const std::vector<std::vector<std::size_t>>& faces) {
  if (mesh.face_count() != faces.size()) return false;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto face = mesh.face(f);
    if (!std::equal(face.begin(), face.end(), faces[f].begin(), faces[f].end())) return false;
  }
  return true;
}

TEST(CgalMeshes, AgreeWithCgalsReader) {
  std::size_t compared = 0;
  for (const std::string& file : mesh_files()) {
    SCOPED_TRACE(file);
    const PolygonMesh mesh = read_mesh(file);
    EXPECT_GT(mesh.points.size(), 0);
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> faces;
    if (!CGAL::IO::read_polygon_soup(file, points, faces)) continue;
    ++compared;
    ASSERT_EQ(mesh.points.size(), points.size());
    // A PLY that declares float is rounded to it by CGAL, and kept as written here.
    EXPECT_LE(largest_difference(mesh.points, points), file.ends_with(".ply") ? 1e-7 : 0.0);
    EXPECT_TRUE(same_faces(mesh, faces));
  }
  EXPECT_EQ(mesh_files().size(), 140);
  EXPECT_EQ(compared, 140);
}

TEST(CgalMeshes, TheContradictoryOneIsReadWhereItCanBeSaid) {
  std::vector<std::string> notes;
  const PolygonMesh mesh = read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + contradictory, &notes);
  EXPECT_EQ(mesh.face_count(), 8U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].ends_with("prim.off:24: 1 more faces than the header's 7, kept")) << notes[0];
  notes.clear();
  for (const std::string& file : mesh_files()) read_mesh(file, &notes);
  EXPECT_TRUE(notes.empty());
}

TEST(CgalMeshes, TheContradictoryOneIsRefusedElsewhere) {
  try {
    read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + contradictory);
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(error.place().ends_with("prim.off:24")) << error.what();
  }
}

TEST(CgalMeshes, RoundTripBitForBit) {
  for (const std::string& file : mesh_files()) {
    SCOPED_TRACE(file);
    const PolygonMesh mesh = read_mesh(file);
    expect_same(parse_ply(ply_bytes(mesh), "again.ply"), mesh);
    expect_same(parse_off(off_text(mesh), "again.off"), mesh);
  }
}

MeshReport report_of(const std::string& name) {
  return inspect(read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + name));
}

/// The holes, components and chi are those that CGAL's border cycles, connected components and Euler count
/// give; the duplicates were counted as equal lines of coordinates.
TEST(CgalMeshes, AreInspectedRightly) {
  MeshReport report = report_of("elephant-with-holes.off");
  EXPECT_EQ(report.points, 2798);
  EXPECT_EQ(report.faces, 4463);
  EXPECT_EQ(report.boundary_loops, 106);
  EXPECT_EQ(report.duplicate_points.size(), 65);
  report = report_of("dino.off");
  EXPECT_TRUE(report.is_closed() && report.is_manifold() && report.is_oriented());
  EXPECT_EQ(report.euler_characteristic, 2);
  report = report_of("diplodocus.off");
  EXPECT_EQ(report.duplicate_points.size(), 2);
  report = report_of("bones.off");
  EXPECT_EQ(report.components, 26);
  report = report_of("boeing.off");
  EXPECT_EQ(report.duplicate_points.size(), 1477);
  report = report_of("blobby-shuffled.off");
  EXPECT_FALSE(report.is_oriented());
}

}  // namespace
}  // namespace tendril::bind
