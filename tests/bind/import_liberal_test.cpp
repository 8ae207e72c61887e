// What a reader does with files that are not as they should be when somebody listens: geometry is read, each
// liberty is told with its place, and what is no geometry never refuses it.

#include <tendril/base/error.h>
#include <tendril/bind/import.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

const std::string kCases = std::string(TENDRIL_SOURCE_DIR) + "/tests/data/cases/";

struct Read {
  PolygonMesh mesh;
  std::string notes;
};

Read read_case(const std::string& name) {
  std::vector<std::string> notes;
  Read out{read_mesh(kCases + name, &notes), ""};
  for (const std::string& note : notes) out.notes += note.substr(note.find(name) + name.size()) + "\n";
  return out;
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes)
      : path_(testing::TempDir() + "liberal_" + std::to_string(::getpid())) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Read read_text(const std::string& bytes) {
  const TemporaryFile file(bytes);
  std::vector<std::string> notes;
  Read out{read_mesh(file.path(), &notes), ""};
  for (const std::string& note : notes) out.notes += note.substr(file.path().size()) + "\n";
  return out;
}

void expect_tetrahedron(const PolygonMesh& mesh) {
  EXPECT_EQ(bits(mesh.points), bits({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}));
}

struct Case {
  const char* file;
  std::vector<Vec3> normals;
  std::vector<Color> colors;
  const char* notes;
};

TEST(ImportLiberally, ReadsTheGeometryOfEveryCase) {
  const std::vector<Color> brown(4, {89, 71, 57, 255});
  const std::vector<Case> all{
      {"attributes/bin_lfcr.ply", {}, {}, ":19: header: lines that end with LF CR\n"},
      {"attributes/coff_float255.off", {}, brown, ""},
      {"attributes/coff_int_alpha_float.off", {}, brown, ""},
      {"attributes/float_colors_1eps.ply", {}, std::vector<Color>(4, {255, 128, 0, 255}), ""},
      {"attributes/nan_color.ply",
       {},
       {},
       ":15: vertex 1: value 'nan' is not finite: vertex colors dropped\n"},
      {"attributes/nan_normal.ply", {}, {}, ":15: vertex 1: value 'nan' is not finite: normals dropped\n"},
      {"attributes/trailing_lf_bin.ply",
       {},
       {},
       ":byte 277: after the last element: 1 bytes are left over, not read\n"},
      {"glued_header/glued.off", {}, {}, ":1: header: no blank between OFF and the number of vertices\n"},
      {"off_columns/ncoff_meshlab_float.off", std::vector<Vec3>(4, Vec3(0.78, -0.605, 0.158)),
       std::vector<Color>(4, {255, 255, 255, 255}),
       ":3: vertex 0: color before normal under NCOFF: read as points, colors, normals\n"},
      {"off_columns/noff_msind.off",
       {},
       {},
       ":5: vertex 2: '-1.#IND' is not a number of double precision: normals dropped\n"},
      {"off_columns/off_with_vertex_rgba_int.off",
       {},
       brown,
       ":3: vertex 0: 7 numbers a vertex under OFF: read as points, colors\n"},
  };
  for (const Case& c : all) {
    SCOPED_TRACE(c.file);
    const Read read = read_case(c.file);
    expect_tetrahedron(read.mesh);
    EXPECT_EQ(bits(read.mesh.point_normals), bits(c.normals));
    EXPECT_EQ(read.mesh.point_colors, c.colors);
    EXPECT_EQ(read.notes, c.notes);
  }
}

TEST(ImportLiberally, ReadsNormalsUnderAPlainOff) {
  const Read read = read_case("off_columns/silent_floor.off");
  EXPECT_EQ(read.mesh.points.size(), 18U);
  EXPECT_EQ(read.mesh.face_count(), 10U);
  EXPECT_EQ(bits(read.mesh.point_normals), bits(std::vector<Vec3>(18, Vec3(0, 0, 1))));
  EXPECT_EQ(read.mesh.points[1], Vec3(3, 1, 2));
}

TEST(ImportLiberally, TakesAFreeFormOffForWhatItIs) {
  // Two vertices a line: six numbers, but half as many lines as vertices.
  const Read read = read_text("OFF\n4 1 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n4 0 1 2 3\n");
  EXPECT_EQ(read.mesh.points[3], Vec3(0, 1, 0));
  EXPECT_EQ(read.notes, "");
  // Six numbers in as many lines as there are vertices, and as many lines more as faces: but none of faces.
  const Read more = read_text("OFF\n4 3 0\n0 0 0 1 0 0\n0 1 0 0 0 1\n5 0 1 2 3 0\n5 1 2 3 0 1\n3\n1 2\n3\n");
  EXPECT_EQ(more.mesh.points[3], Vec3(0, 0, 1));
  EXPECT_EQ(more.mesh.face_count(), 3u);
  EXPECT_EQ(more.notes, "");
}

TEST(ImportLiberally, NamesASurplusItCannotTell) {
  const char* const faces = "3 0 1 2\n";
  for (const char* rest : {" 7", " 0.2 0.3 0.4 0.5 0.6 0.7 0.8", " -3 4 900", " 0.2 300 7"}) {
    std::string text = "OFF\n3 1 0\n";
    for (const char* point : {"0 0 0", "1 0 0", "0 1 0"}) text += point + std::string(rest) + "\n";
    try {
      read_text(text + faces);
      ADD_FAILURE() << "accepted: " << rest;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(":3: vertex 0: "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("COFF or NOFF?"), std::string::npos) << error.what();
    }
  }
}

TEST(ImportLiberally, LetsALineOfNoNumbersSayNothingOfItsColumns) {
  // Out of any range on the first line: a nan behind it must not make that a color after all.
  EXPECT_THROW(read_text("OFF\n3 1 0\n0 0 0 300 7.5 9\n1 0 0 nan nan nan\n0 1 0 1 2 3\n3 0 1 2\n"),
               InvalidInput);
}

TEST(ImportLiberally, RefusesALibertyWhereNobodyIsTold) {
  for (const char* name : {"attributes/bin_lfcr.ply", "attributes/nan_color.ply", "attributes/nan_normal.ply",
                           "attributes/trailing_lf_bin.ply", "glued_header/glued.off",
                           "meshes/binary_little_endian.off", "meshes/surplus_at_line_ends.ply",
                           "off_columns/ncoff_meshlab_float.off", "off_columns/noff_msind.off",
                           "off_columns/off_with_vertex_rgba_int.off", "off_columns/silent_floor.off"})
    EXPECT_THROW(read_mesh(kCases + name), InvalidInput) << name;
}

TEST(ImportLiberally, ReadsBinaryOffOfOtherByteOrder) {
  const Read read = read_case("meshes/binary_little_endian.off");
  EXPECT_EQ(read.mesh.points.size(), 8U);
  EXPECT_EQ(read.mesh.face_count(), 6U);
  EXPECT_EQ(read.mesh.points[7], Vec3(0, 1, 1));
  EXPECT_NE(read.notes.find("little-endian, without a count of color values"), std::string::npos)
      << read.notes;
}

/// A triangle with a color, or without the count of its values.
std::string binary_triangle(bool big_endian, bool count) {
  Bytes file("OFF BINARY\n", big_endian);
  file.put(3, 1, 0);
  file.put(0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F);
  file.put(3, 0, 1, 2);
  if (count) file.put(3).put(1.0F, 0.0F, 0.0F);
  return file.str();
}

TEST(ImportLiberally, ReadsBinaryOffInEveryDialect) {
  for (const bool big : {false, true})
    for (const bool count : {false, true}) {
      const Read read = read_text(binary_triangle(big, count));
      EXPECT_EQ(read.mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
      EXPECT_EQ(read.mesh.face_colors, std::vector<Color>(count ? 1 : 0, Color{255, 0, 0, 255}));
      EXPECT_EQ(read.notes.empty(), big && count) << read.notes;
    }
}

TEST(ImportLiberally, KeepsTheGeometryOfLinesWithASurplus) {
  const Read read = read_case("meshes/surplus_at_line_ends.ply");
  EXPECT_EQ(read.mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(read.mesh.face_colors.empty());
  EXPECT_NE(read.notes.find(":17: face 0: the value '30' is one too many"), std::string::npos) << read.notes;
}

TEST(ImportLiberally, PassesOverAHeaderLineThatIsNoKeyword) {
  const std::string head = "ply\nformat ascii 1.0\nmade by hand\nelement vertex 1\nproperty float x\n";
  const Read read = read_text(head + "property float y\nproperty float z\nend_header\n1 2 3\n");
  EXPECT_EQ(read.mesh.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(read.notes, ":3: header: a line that begins with 'made', taken for a comment\n");
}

TEST(ImportLiberally, NamesAPointerToAFileKeptElsewhere) {
  try {
    read_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 12\n");
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("Git LFS pointer"), std::string::npos) << error.what();
  }
}

TEST(ImportLiberally, TellsANegativeNumberOfEdges) {
  const Read read = read_text("OFF\n3 1 -1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(read.mesh.face_count(), 1U);
  EXPECT_EQ(read.notes, ":2: header: the number of edges is '-1'\n");
}

TEST(Import, TakesNumbersBelowTheRangeForZero) {
  for (const char* tiny :
       {"1e-400", "0.001e-330", "-1E-99999999999999999999", "1000e-1000", "0e999999999999"})
    EXPECT_EQ(parse_off(std::string("OFF 1 0 0\n") + tiny + " 1 2\n", "a").points[0], Vec3(0, 1, 2)) << tiny;
  for (const char* huge : {"1e400", "0.001e330", "1e99999999999999999999", "-1000e400"})
    EXPECT_THROW(parse_off(std::string("OFF 1 0 0\n") + huge + " 1 2\n", "a"), InvalidInput) << huge;
}

TEST(Import, ReadsTriangleStrips) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const PolygonMesh mesh = parse_ply(head + points + "11 0 1 2 3 3 4 -1 3 5 4 4\n", "a.ply");
  // The point named twice leads on without a face; each second triangle is turned.
  EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 3, 5, 4}));
  EXPECT_THROW(parse_ply(head + points + "3 0 1 6\n", "a.ply"), InvalidInput);
  EXPECT_THROW(parse_ply(head + points + "3 0 1 -2\n", "a.ply"), InvalidInput);
}

}  // namespace
}  // namespace tendril::bind
