#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>

#include <functional>

#include "mesh_notes.h"
#include "mesh_text.h"

namespace tendril::bind {
namespace {

const std::string sheet = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

/// `text` with its only or first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(RejectOff, Headers) {
  const std::vector<BadFile> table{
      {"", "1", "file ends"},
      {"\n# only a comment\n", "3", "file ends"},
      {"off\n0 0 0\n", "1", "'off'"},
      {"OFFF\n0 0 0\n", "1", "'OFFF'"},
      {"CCOFF\n0 0 0\n", "1", "'CCOFF'"},
      {"XOFF\n0 0 0\n", "1", "'XOFF'"},
      {"OFF490 518 0\n", "1", "'OFF490'"},
      {"4 2 0\n0 0 0\n", "1", "'4'"},
      {"4OFF\n1 0 0\n0 0 0 1\n", "1", "not points of space"},
      {"nOFF 3\n1 0 0\n0 0 0\n", "1", "not points of space"},
      {"C4nOFF\n1 0 0\n0 0 0\n", "1", "not points of space"},
      {"OFF", "1", "file ends"},
      {"OFF\n", "2", "file ends"},
      {"OFF\n4\n2 0\n", "2", "fewer than three counts"},
      {"OFF\n4 2\n0 0 0\n", "2", "fewer than three counts"},
      {"OFF\n-1 0 0\n", "2", "number of vertices is '-1'"},
      {"OFF\n0 -2 0\n", "2", "number of faces is '-2'"},
      {"OFF\n4.5 2 0\n", "2", "number of vertices is '4.5'"},
      {"OFF\n4 2 edges\n", "2", "number of edges is 'edges'"},
      {"OFF\n4294967296 0 0\n", "2", "number of vertices"},
      {"OFF\n99999999999999999999999 0 0\n", "2", "number of vertices"},
      {std::string("OFF\0\n0 0 0\n", 11), "1", "'OFF?'"},
      {"OFF BINARY text\n", "1", "text after BINARY"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_off);
}

TEST(RejectOff, Vertices) {
  const std::vector<BadFile> table{
      {with(sheet, "1 1 0", "1 nan 0"), "5", "vertex 2: coordinate 'nan' is not finite"},
      {with(sheet, "1 1 0", "1 1 inf"), "5", "vertex 2: coordinate 'inf' is not finite"},
      {with(sheet, "1 1 0", "-infinity 1 0"), "5", "vertex 2: coordinate '-infinity' is not finite"},
      {with(sheet, "1 1 0", "1 1e400 0"), "5", "vertex 2: '1e400' is not a number of double precision"},

      {with(sheet, "1 1 0", "1 1,5 0"), "5", "vertex 2: '1,5' is not a number"},
      {with(sheet, "1 1 0", "1 one 0"), "5", "vertex 2: 'one' is not a number"},
      {with(sheet, "1 1 0", "1 0x1p3 0"), "5", "vertex 2: '0x1p3' is not a number"},
      {with(sheet, "1 1 0", "1 +-1 0"), "5", "vertex 2: '+-1' is not a number"},
      {with(sheet, "1 1 0", "1 + 0"), "5", "vertex 2: '+' is not a number"},
      {with(sheet, "1 1 0", "1 1.2.3 0"), "5", "vertex 2: '1.2.3' is not a number"},
      {with(sheet, "1 1 0", "1 " + std::string(1000000, '7') + "x 0"), "5",
       "'7777777777777777777777777777777777777777...'"},
      {"OFF\n2 0 0\n0 0 0\n0 0", "4", "vertex 1: the file ends"},
      {"OFF\n2000000000 0 0\n0 0 0\n", "4", "vertex 1: the file ends"},
      {"NOFF\n1 0 0\n0 0 0\n", "4", "vertex 0: the file ends"},
      {"NOFF\n1 0 0\n0 0 0 0 0 nan\n", "3", "normal 'nan' is not finite"},
      {"COFF\n1 0 0\n0 0 0\n", "3", "only 0 values"},
      {"COFF\n1 0 0\n0 0 0 1 1\n", "3", "only 2 values"},
      {"COFF\n1 0 0\n0 0 0 1 1 1 1 1\n", "3", "'1' is one too many"},
      {"COFF\n1 0 0\n0 0 0 256 0 0\n", "3", "color outside"},
      {"COFF\n1 0 0\n0 0 0 -1 0 0\n", "3", "color outside"},
      {"COFF\n1 0 0\n0 0 0 red 0 0\n", "3", "'red' is not a number"},
      {"COFF\n2 0 0\n0 0 0 255 0 0\n0 0 0 0.5 0 0\n", "4", "both ranges"},
      {"STOFF\n1 0 0\n0 0 0 0.5\n", "4", "file ends"},
      {"STCOFF\n1 0 0\n0 0 0 1 1 1 0\n", "3", "only 4 values"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_off);
}

TEST(RejectOff, Faces) {
  const std::vector<BadFile> table{
      {with(sheet, "3 0 1 2", "3 0 1 4"), "7", "face 0: vertex index '4'"},
      {with(sheet, "3 0 1 2", "3 0 -1 2"), "7", "face 0: vertex index '-1'"},
      {with(sheet, "3 0 1 2", "3 0 0.9 2"), "7", "face 0: vertex index '0.9'"},
      {with(sheet, "3 0 1 2", "3 0 4294967297 2"), "7", "face 0: vertex index '4294967297'"},
      {with(sheet, "3 0 1 2", "3 0 nan 2"), "7", "face 0: vertex index 'nan'"},
      {with(sheet, "3 0 1 2", "2 0 1"), "7", "face 0: a face of '2' corners"},
      {with(sheet, "3 0 1 2", "0"), "7", "face 0: a face of '0' corners"},
      {with(sheet, "3 0 1 2", "-3 0 1 2"), "7", "face 0: a face of '-3' corners"},
      {with(sheet, "3 0 1 2", "3.5 0 1 2"), "7", "face 0: a face of '3.5' corners"},
      {with(sheet, "3 0 1 2", "nan 0 1 2"), "7", "face 0: a face of 'nan' corners"},
      {with(sheet, "3 0 1 2", "2000000000 0 1 2"), "9", "face 0: the file ends"},
      {with(sheet, "3 0 1 2", "1e300 0 1 2"), "7", "face 0: more than 2^32 - 1 corners"},
      {with(sheet, "3 0 1 2", "3 0 1 2 5 5"), "7", "face 0: a color that is none"},
      {with(sheet, "3 0 1 2", "3 0 1 2 0.5"), "7", "face 0: a color that is none"},
      {with(sheet, "3 0 1 2", "3 0 1 2 1 1 1 1 1"), "7", "face 0: the value '1' is one too many"},
      {with(sheet, "3 0 1 2\n", "3 0 1 2 "), "8", "face 1: the file ends"},
      {with(sheet, "4 2 0", "4 3 0"), "9", "face 2: the file ends"},
      {with(sheet, "4 2 0", "4 1 0"), "8", "after the last face: '3' is left over"},
      {with(sheet, "4 2 0", "3 2 0"), "6", "face 0: a face of '0' corners"},
      {sheet + "garbage\n", "9", "'garbage' is left over"},
      {sheet + std::string(1, '\0'), "9", "'?' is left over"},
      {"OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 3\r\n", "6", "vertex index '3'"},
      {"OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 3\r", "6", "vertex index '3'"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_off);
}

/// One triangle in binary OFF; byte 11 begins the counts, 23 the points, 59 the face.
std::string binary_off(std::int32_t vertices, float z, std::int32_t degree, std::int32_t index,
                       std::int32_t colors) {
  Bytes file("OFF BINARY\n", true);
  file.put(vertices, 1, 0, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, z);
  return file.put(degree, 0, 1, index, colors).str();
}

TEST(RejectOff, Binary) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string good = binary_off(3, 0, 3, 2, 0);
  ASSERT_EQ(parse_off(good, "good").face_count(), 1);
  const std::vector<BadFile> table{
      {binary_off(-1, 0, 3, 2, 0), "byte 11", "number of vertices is -1"},
      {binary_off(2000000000, 0, 3, 2, 0), "byte 79", "the file ends here"},
      {binary_off(3, nan, 3, 2, 0), "byte 55", "vertex 2: coordinate nan is not finite"},
      {binary_off(3, 0, 2, 2, 0), "byte 59", "face 0: a face of 2 corners"},
      {binary_off(3, 0, -3, 2, 0), "byte 59", "face 0: a face of -3 corners"},
      {binary_off(3, 0, 2000000000, 2, 0), "byte 63", "face 0: the file ends here, 16 bytes"},
      {binary_off(3, 0, 3, 3, 0), "byte 71", "face 0: vertex index 3"},
      {binary_off(3, 0, 3, -1, 0), "byte 71", "face 0: vertex index -1"},
      {binary_off(3, 0, 3, 2, 2), "byte 75", "face 0: 2 color values"},
      {binary_off(3, 0, 3, 2, 5), "byte 75", "face 0: 5 color values"},
      {binary_off(3, 0, 3, 2, 3), "byte 79", "face 0: the file ends"},
      {good + "\n", "byte 79", "1 bytes are left over"},
      {good.substr(0, 20), "byte 19", "header: the file ends"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_off);
}

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(RejectPly, HeaderLines) {
  const std::vector<BadFile> table{
      {"", "1", "file ends"},
      {"PLY\n", "1", "'PLY'"},
      {"ply", "1", "file ends"},
      {"ply extra\n", "1", "'extra' is one too many"},
      {with(ply, "end_header\n", ""), "9", "unknown keyword '0'"},
      {ply.substr(0, ply.find("end_header")), "9", "file ends"},
      {with(ply, "format ascii 1.0\n", ""), "8", "no line 'format'"},
      {with(ply, "ascii", "pl1.0"), "2", "format 'pl1.0'"},
      {with(ply, "ascii 1.0", "ascii 2.0"), "2", "version '2.0'"},
      {with(ply, "ascii 1.0", "ascii"), "2", "line ends after 'ascii'"},
      {with(ply, "ascii 1.0\n", "ascii 1.0\nformat ascii 1.0\n"), "3", "second line 'format'"},
      {with(ply, "element vertex 3\n", ""), "3", "property before any element"},
      {with(ply, "element vertex 3", "element vertex"), "3", "line ends after 'vertex'"},
      {with(ply, "element vertex 3", "element vertex -3"), "3", "number of elements is '-3'"},
      {with(ply, "element vertex 3", "element vertex 3.5"), "3", "number of elements is '3.5'"},
      {with(ply, "element vertex 3", "element vertex 99999999999999999999"), "3", "number of elements"},
      {with(ply, "element vertex 3", "element vertex 3 4"), "3", "'4' is one too many"},
      {with(ply, "element face", "element vertex"), "7", "second element 'vertex'"},
      {with(ply, "float y", "real y"), "5", "unknown type 'real'"},
      {with(ply, "float y", "float"), "5", "line ends after 'float'"},
      {with(ply, "float y", "float x"), "5", "second property 'x'"},
      {with(ply, "uchar int v", "float int v"), "8", "length of type 'float'"},
      {with(ply, "uchar int v", "list int v"), "8", "unknown type 'list'"},
      {with(ply, "list uchar int vertex_indices", "list uchar int"), "8", "line ends after 'int'"},
      {with(ply, "end_header\n", "end_header now\n"), "9", "' now' after end_header"},
      {with(ply, "format", "fromat"), "2", "unknown keyword 'fromat'"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_ply);
}

TEST(RejectPly, HeadersThatDoNotMakeAMesh) {
  const std::vector<BadFile> table{
      {"ply\nformat ascii 1.0\nend_header\n", "3", "no element 'vertex'"},
      {with(ply, "property float z\n", ""), "8", "vertices without z"},
      {with(ply, "float y", "list uchar float y"), "9", "vertices without y"},
      {with(ply, "element vertex 3", "element vertex 4294967296"), "9", "too many vertices"},
      {with(ply, "vertex_indices", "indices"), "9", "faces without corners"},
      {with(ply, "list uchar int vertex_indices", "int vertex_indices"), "9", "faces without corners"},
      {with(ply, "end_header", "property list uchar int vertex_index\nend_header"), "10", "both"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_ply);
}

TEST(RejectPly, TextBody) {
  const std::vector<BadFile> table{
      {with(ply, "\n1 0 0", "\n1 nan 0"), "11", "vertex 1: value 'nan' is not finite"},
      {with(ply, "\n1 0 0", "\n1 1e400 0"), "11", "vertex 1: '1e400' is not a number"},
      {with(ply, "\n1 0 0", "\n1 0,5 0"), "11", "vertex 1: '0,5' is not a number"},
      {with(ply, "\n1 0 0", "\n1 0 0 0"), "11", "vertex 1: the value '0' is one too many"},
      {with(ply, "\n1 0 0", "\n1 0"), "12", "vertex 1: the value '1' is one too many"},
      {with(with(ply, "float y", "int y"), "\n1 0 0", "\n1 0.5 0"), "11", "'0.5' for an integer property"},
      {with(ply, "\n1 0 0", "\n#\n1 0 0"), "11", "vertex 1: '#' is not a number"},
      {with(ply, "3 0 1 2", "3 0 1 3"), "13", "face 0: vertex index '3'"},
      {with(ply, "3 0 1 2", "3 0 1 -1"), "13", "face 0: vertex index '-1'"},
      {with(ply, "3 0 1 2", "3 0 1 0.9"), "13", "face 0: vertex index '0.9'"},
      {with(ply, "3 0 1 2", "2 0 1"), "13", "face 0: a face of '2' corners"},
      {with(ply, "3 0 1 2", "-3 0 1 2"), "13", "face 0: a face of '-3' corners"},
      {with(ply, "3 0 1 2", "3 0 1 2 0"), "13", "face 0: the value '0' is one too many"},
      {with(ply, "3 0 1 2", "2000000000 0 1 2"), "14", "face 0: the file ends"},
      {with(ply, "element face 1", "element face 2"), "14", "face 1: the file ends"},
      {with(ply, "element face 1", "element face 0"), "13", "after the last element: '3' is left over"},
      {with(with(ply, "element face",
                 "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face"),
            "\n0 0 0\n", "\n0 0 0 0 256 0\n"),
       "13", "vertex 0: color '256'"},
      {with(with(ply, "element face",
                 "property float red\nproperty float green\nproperty float blue\nelement face"),
            "\n0 0 0\n", "\n0 0 0 0 1.5 0\n"),
       "13", "vertex 0: color '1.5'"},
      {with(
           with(ply, "element face", "property float nx\nproperty float ny\nproperty float nz\nelement face"),
           "\n0 0 0\n", "\n0 0 0 0 inf 0\n"),
       "13", "vertex 0: value 'inf'"},
      {with(with(ply, "element vertex", "element a 1\nproperty list int int b\nelement vertex"), "r\n0",
            "r\n-1\n0"),
       "12", "a 0: a list of length '-1'"},
      {ply + "0\n", "14", "'0' is left over"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_ply);
}

const std::string binary_head =
    "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
    "float z\n"
    "element face 1\nproperty list int int vertex_indices\nend_header\n";

std::string binary_ply(float y, std::int32_t degree, std::int32_t index) {
  Bytes file(binary_head, false);
  return file.put(0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, y, 0.0F).put(degree, 0, 1, index).str();
}

TEST(RejectPly, BinaryBody) {
  const std::string good = binary_ply(1, 3, 2);
  ASSERT_EQ(parse_ply(good, "good").face_count(), 1);
  const auto byte = [](std::size_t n) { return "byte " + std::to_string(binary_head.size() + n); };
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<BadFile> table{
      {binary_ply(inf, 3, 2), byte(28), "vertex 2: value inf is not finite"},
      {binary_ply(1, 3, 3), byte(48), "face 0: vertex index 3"},
      {binary_ply(1, 3, -1), byte(48), "face 0: vertex index -1"},
      {binary_ply(1, 2, 1), byte(36), "face 0: a face of 2 corners"},
      {binary_ply(1, -1, 1), byte(36), "face 0: a face of -1 corners"},
      {binary_ply(1, (1 << 30) - 1, 1), byte(40), "face 0: the file ends here, 12 bytes are left"},
      {good + "x", byte(52), "1 bytes are left over"},
      {binary_head, byte(0), "vertex 0: the file ends here, 0 bytes"},
      {with(binary_head, "vertex 3", "vertex 4294967295"), "byte " + std::to_string(binary_head.size() + 9),
       "vertex 0"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_ply);
}

/// Cut after every byte: the file is refused, or complete as the whole one is when only its end of line is
/// missing.
void expect_complete_or_refused(const std::string& whole,
                                PolygonMesh (*parse)(std::string_view, const std::string&),
                                std::size_t dispensable) {
  const PolygonMesh mesh = parse(whole, "whole");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // An own copy of just these bytes, so that a sanitizer sees any read beyond them.
    const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    try {
      const PolygonMesh part = parse(std::string_view(cut.data(), cut.size()), "cut");
      EXPECT_GE(size + dispensable, whole.size()) << "accepted when cut to " << size;
      expect_same(part, mesh);
    } catch (const InvalidInput& error) {
      EXPECT_LT(size + dispensable, whole.size()) << error.what();
    }
  }
}

TEST(Truncation, IsRefusedAtEveryByte) {
  PolygonMesh mesh = house();
  mesh.point_normals.assign(5, Vec3(0, 0.5, 1));
  mesh.point_colors.assign(5, {1, 2, 3, 4});
  expect_complete_or_refused(off_text(mesh), parse_off, 1);
  expect_complete_or_refused(ply, parse_ply, 1);
  expect_complete_or_refused(ply_bytes(mesh), parse_ply, 0);
  expect_complete_or_refused(binary_off(3, 0.5F, 3, 2, 0), parse_off, 0);
}

/// A flip may leave another good file; it must never crash or give a mesh whose arrays do not fit together.
TEST(BitFlips, GiveAValidMeshOrARefusal) {
  PolygonMesh mesh = house();
  mesh.face_colors.assign(2, {1, 2, 3, 4});
  std::size_t refused = 0;
  for (const std::string& whole : {ply_bytes(mesh), off_text(mesh), binary_off(3, 0.5F, 3, 2, 0)}) {
    for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
      std::string bytes = whole;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      try {
        require_valid(whole.starts_with("ply") ? parse_ply(bytes, "flip") : parse_off(bytes, "flip"));
      } catch (const InvalidInput& error) {
        EXPECT_TRUE(error.place().starts_with("flip:")) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace tendril::bind
