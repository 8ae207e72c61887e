#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

namespace fs = std::filesystem;
using Limits = std::numeric_limits<double>;

/// A folder of this test's own, removed at its end.
class ExportFiles : public testing::Test {
 protected:
  ExportFiles() : folder_(fs::path(testing::TempDir()) / ("tendril-export-" + std::to_string(::getpid()))) {
    fs::create_directory(folder_);
  }
  ~ExportFiles() override { fs::remove_all(folder_); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

 private:
  fs::path folder_;
};

/// Any finite double: random bits, with the special values in front.
std::vector<double> hard_doubles(std::size_t count) {
  std::vector<double> values{0.0, -0.0, Limits::denorm_min(), -Limits::min(), Limits::max(), Limits::lowest(),
                             0.1};
  std::mt19937_64 random(7);
  while (values.size() < count) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

PolygonMesh hard_mesh() {
  const std::vector<double> values = hard_doubles(600);
  PolygonMesh mesh;
  for (std::size_t i = 0; i < 100; ++i) {
    mesh.points.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    mesh.point_normals.emplace_back(values[300 + 3 * i], values[301 + 3 * i], values[302 + 3 * i]);
    const auto byte = static_cast<std::uint8_t>(i);
    mesh.point_colors.push_back({byte, 0, 1, static_cast<std::uint8_t>(255 - i)});
    mesh.point_texture.push_back({values[i + 3], values[i + 200]});
  }
  std::mt19937 random(3);
  for (std::uint32_t f = 0; f < 50; ++f) {
    for (std::uint32_t k = 0; k < 3 + f % 4; ++k)
      mesh.corners.push_back(static_cast<std::uint32_t>(random() % 100));
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    mesh.face_colors.push_back({static_cast<std::uint8_t>(f), 7, 1, 0});
  }
  return mesh;
}

PolygonMesh fan(std::uint32_t degree) {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> face;
  for (std::uint32_t i = 0; i < degree; ++i) {
    points.emplace_back(std::cos(i), std::sin(i), 0.0);
    face.push_back(i);
  }
  return mesh_of(points, {face});
}

TEST(Export, RoundTripsBitForBit) {
  for (const PolygonMesh& mesh : {tetrahedron(), house(), hard_mesh(), PolygonMesh{}, fan(255), fan(256)}) {
    expect_same(parse_ply(ply_bytes(mesh), "mesh.ply"), mesh);
    expect_same(parse_off(off_text(mesh), "mesh.off"), mesh);
  }
}

TEST(Export, RoundTripsEachAttributeAlone) {
  for (int kept = 0; kept < 4; ++kept) {
    PolygonMesh mesh = hard_mesh();
    if (kept != 0) mesh.point_normals.clear();
    if (kept != 1) mesh.point_colors.clear();
    if (kept != 2) mesh.face_colors.clear();
    if (kept != 3) mesh.point_texture.clear();
    expect_same(parse_ply(ply_bytes(mesh), "mesh.ply"), mesh);
    expect_same(parse_off(off_text(mesh), "mesh.off"), mesh);
  }
}

/// A list of more than 255 numbers has a longer count than that of corners, which are half as many.
TEST(Export, RoundTripsTextureCoordinatesOfCorners) {
  for (PolygonMesh mesh : {house(), hard_mesh(), fan(127), fan(128), fan(256)}) {
    const std::vector<double> values = hard_doubles(2 * mesh.corners.size());
    for (std::size_t c = 0; c < mesh.corners.size(); ++c)
      mesh.corner_texture.push_back({values[2 * c], values[2 * c + 1]});
    expect_same(parse_ply(ply_bytes(mesh), "mesh.ply"), mesh);
    PolygonMesh without = mesh;
    without.corner_texture.clear();
    expect_same(parse_off(off_text(mesh), "mesh.off"), without);
  }
  PolygonMesh mesh = house();
  mesh.corner_texture.assign(7, {0.1, 0.2});
  EXPECT_EQ(parse_ply(ply_bytes(mesh, {.float32 = true}), "a").corner_texture[6],
            (TextureCoordinate{static_cast<double>(0.1F), static_cast<double>(0.2F)}));
}

TEST(Export, WritesTheKnownText) {
  PolygonMesh mesh = house();
  mesh.face_colors = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  EXPECT_EQ(off_text(mesh),
            "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 1.5 -0.25\n4 0 1 2 3 1 2 3 4\n3 3 2 4 5 6 7 8\n");
}

TEST(Export, SinglePrecisionRoundsAndHalvesTheSize) {
  PolygonMesh mesh = tetrahedron();
  mesh.points[1].x() = 0.1;
  const std::string bytes = ply_bytes(mesh, {.float32 = true});
  EXPECT_EQ(parse_ply(bytes, "mesh.ply").points[1].x(), static_cast<double>(0.1F));
  EXPECT_EQ(ply_bytes(mesh).size() - bytes.size(), 4 * 12 + 3);  // "double" is a letter longer than "float"
  mesh.points[2].z() = 1e39;
  EXPECT_THROW(ply_bytes(mesh, {.float32 = true}), InvalidInput);
}

/// The place of the error that writing gives.
std::string refused_place(const PolygonMesh& mesh) {
  for (const bool ply : {true, false}) {
    try {
      const std::string bytes = ply ? ply_bytes(mesh) : off_text(mesh);
      ADD_FAILURE() << "written: " << bytes.size() << " bytes";
    } catch (const InvalidInput& error) {
      if (!ply) return error.place();
    }
  }
  return {};
}

TEST(Export, RefusesAMeshThatDoesNotFitTogether) {
  PolygonMesh mesh = house();
  mesh.points[3].y() = Limits::quiet_NaN();
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: points[3]");
  mesh = house();
  mesh.corners[5] = 5;
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: corners[5]");
  mesh = house();
  mesh.face_begin[1] = 2;
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: face_begin[1]");
  mesh = house();
  mesh.corners.push_back(0);
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: face_begin[2]");
  mesh = house();
  mesh.face_begin.clear();
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: face_begin[0]");
  mesh = house();
  mesh.face_colors.resize(1);
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: face_colors");
  mesh = house();
  mesh.corner_texture.resize(6);
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: corner_texture");
  mesh = house();
  mesh.point_texture.assign(5, {0.0, Limits::infinity()});
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: point_texture[0]");
  mesh = house();
  mesh.point_normals.assign(5, Vec3::Constant(Limits::infinity()));
  EXPECT_EQ(refused_place(mesh), "PolygonMesh: point_normals[0]");
}

TEST_F(ExportFiles, AreWrittenByEndingAndReadByContent) {
  for (const char* name : {"mesh.ply", "mesh.off"}) {
    write_mesh(file(name), hard_mesh());
    expect_same(read_mesh(file(name)), hard_mesh());
  }
  fs::rename(file("mesh.ply"), file("renamed.off"));
  expect_same(read_mesh(file("renamed.off")), hard_mesh());
  EXPECT_THROW(write_mesh(file("mesh.obj"), house()), InvalidInput);
  EXPECT_EQ(entries(), 2);
}

TEST_F(ExportFiles, FailureLeavesTheOldFileAndNoOther) {
  write_mesh(file("mesh.ply"), house());
  PolygonMesh bad = house();
  bad.points[0].x() = Limits::infinity();
  EXPECT_THROW(write_mesh(file("mesh.ply"), bad), InvalidInput);
  EXPECT_THROW(write_mesh(file("none/mesh.ply"), house()), FileError);
  expect_same(read_mesh(file("mesh.ply")), house());
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace tendril::bind
