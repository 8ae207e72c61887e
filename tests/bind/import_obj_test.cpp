#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/import.h>

#include <limits>
#include <locale>

#include "mesh_notes.h"

namespace tendril::bind {
namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

PolygonMesh triangle() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
}

std::string with_ends(std::string text, const std::string& end) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
    text.replace(at, 1, end);
  return text;
}

TEST(ParseObj, AcceptsEveryWayToWriteTheSame) {
  const std::string plain = obj_text(tetrahedron());
  const std::string points = plain.substr(0, plain.find('f')), faces = plain.substr(plain.find('f'));
  const std::vector<std::string> variants{
      plain,
      with_ends(plain, "\r\n"),
      with_ends(plain, "\r"),
      with_ends(plain, " \t\n\n"),
      with_ends(plain, " # a comment\n"),
      "\xEF\xBB\xBF" + plain,
      plain.substr(0, plain.size() - 1),
      "# made\nmtllib a b.mtl\no a thing#1\ng left arm\n" + points + "usemtl grey\ns off\n" + faces + "s 1\n",
      points + "f 1 3 2\nf 1 2 \\\n4\nf \\\r\n2 3 \\ \n \\\n 4\nf 3 1 4 \\",
      points + "f -4 -2 -3\nf -4 -3 -1\nf 2 3 4\nf 3 -4 4\n",
      faces + points,  // of lines to come
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\nv 0 0 1\nf 1 2 -1\nf 2 3 4\nf 3 1 4\n",
      points + "f 1/ 3// 2\nf 1 2 4\nfo 2 3 4\nf 3 1 4\n",
      "v +0 0. .0 1\nv 1e0 0 0 0.5\n\tv 0 10E-1 0\nv 0 0e5 0.1e+1\n" + faces,
  };
  for (const std::string& text : variants) {
    SCOPED_TRACE(text);
    expect_same(parse_obj(text, "a.obj"), tetrahedron());
  }
}

TEST(ParseObj, ReadsPolygonsAndNumbersToTheLastBit) {
  expect_same(parse_obj(obj_text(house()), "a"), house());
  using Doubles = std::numeric_limits<double>;
  const PolygonMesh mesh =
      parse_obj("v 0.1 1e-320 -0\nv 1.7976931348623157e308 4.9406564584124654e-324 1e-400\n", "a");
  EXPECT_EQ(bits(mesh.points), bits({{0.1, 1e-320, -0.0}, {Doubles::max(), Doubles::denorm_min(), 0}}));
}

TEST(ParseObj, ReadsColors) {
  const Color red{255, 0, 0, 255};
  PolygonMesh expected = triangle();
  expected.point_colors = {red, red, {255, 0, 0, 51}};
  expect_same(parse_obj("v 0 0 0 1. 0 0\nv 1 0 0 1 0 0 1\nv 0 1 0 1.0 0 0 0.2\nf 1 2 3\n", "a"), expected);
  expect_same(parse_obj("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0 .2\nf 1 2 3\n", "a"), expected);
  expect_same(parse_obj("v 0 0 0 255 0 0\nv 1 0 0 255 0 0\nv 0 1 0 255 0 0 51\nf 1 2 3\n", "a"), expected);
}

TEST(ParseObj, KeepsNormalsThatAreAVertexOwn) {
  PolygonMesh expected = triangle();
  expected.point_normals = {{0, 0, 1}, {0, 0, 1}, {0, 2, 0}};
  const std::string normals = "vn 0 0 1\nvn 0 2 0\nvn 0 0 1\n";
  expect_same(parse_obj(corners + normals + "f 1//1 2//1 3//2\n", "a"), expected);
  // Another entry of the same value, counted backwards, named before it stands, and in one face of two.
  expect_same(parse_obj(corners + normals + "f 1//3 2//-3 3//-2\n", "a"), expected);
  expect_same(parse_obj(corners + "f 1//1 2//1 3//2\n" + normals, "a"), expected);
  const PolygonMesh two = parse_obj(corners + normals + "f 1//3 2//-3 3//-2\nf 1 2 3\nv 7 7 7\n", "a");
  EXPECT_EQ(two.point_normals[2], Vec3(0, 2, 0));
  EXPECT_EQ(two.point_normals[3], Vec3(0, 0, 0));  // in no face
}

TEST(ParseObj, DropsNormalsThatAreNotAndSaysSo) {
  const std::string normals = "vn 0 0 1\nvn 0 2 0\n";
  for (const auto& [faces, note] :
       {std::pair{"f 1//1 2//1 3//1\nf 1//1 2//2 3//1\n",
                  ": vertex 1 has several normals: normals dropped\n"},
        std::pair{"f 1//1 2//1 3\n", ": vertex 2 has no normal: normals dropped\n"}}) {
    const Told read = read_told(corners + normals + faces, ".obj");
    EXPECT_TRUE(read.mesh.point_normals.empty());
    EXPECT_EQ(read.notes, note);
    EXPECT_TRUE(parse_obj(corners + normals + faces, "a").point_normals.empty());  // no reason to refuse
  }
}

TEST(ParseObj, ReadsTextureCoordinatesOfPointsElseOfCorners) {
  const std::string texture = "vt 0 0.25\nvt 0.5\nvt 1 0 0.75\nvt 0.5 0 1\n";
  PolygonMesh expected = triangle();
  expected.point_texture = {{0, 0.25}, {0.5, 0}, {1, 0}};
  expect_same(parse_obj(corners + texture + "f 1/1 2/2 3/3\n", "a"), expected);
  expect_same(parse_obj(texture + corners + "f 1/-4 2/4 3/3\n", "a"), expected);
  PolygonMesh seam = mesh_of(triangle().points, {{0, 1, 2}, {2, 1, 0}});
  seam.corner_texture = {{0, 0.25}, {0.5, 0}, {1, 0}, {1, 0}, {1, 0}, {0, 0.25}};
  expect_same(parse_obj(corners + texture + "f 1/1 2/2 3/3\nf 3/3 2/3 1/1\n", "a"), seam);
  seam.corner_texture = {{0, 0.25}, {0.5, 0}, {1, 0}, {0, 0}, {0, 0}, {0, 0}};
  const Told some = read_told(corners + texture + "f 1/1 2/2 3/3\nf 3 2 1\n", ".obj");
  expect_same(some.mesh, seam);
  EXPECT_EQ(some.notes, ": 3 corners without texture coordinates: 0 0\n");
}

TEST(ParseObj, SkipsWhatIsNoMeshAndSaysSo) {
  const std::string text = "vp 0 0\n" + corners + "l 1 2 3\np 1\ncstype bspline\ndeg 3\nf 1 2 3\nend\n";
  const Told read = read_told(text, ".obj");
  expect_same(read.mesh, triangle());
  EXPECT_EQ(read.notes,
            ":1: 6 lines of points, lines, curves or free-form surfaces, not read, the first 'vp'\n");
  expect_same(parse_obj(text, "a"), triangle());
}

TEST(ParseObj, PassesOverLinesOfUnknownWordsWhereItCanSaySo) {
  const std::string text = corners + "\nweight 3 4\nf 1 2 3\nweights\n";
  const Told read = read_told(text, ".obj");
  expect_same(read.mesh, triangle());
  EXPECT_EQ(read.notes, ":5: 2 lines that begin with an unknown word, not read, the first 'weight'\n");
  expect_refused({text, "5", "unknown keyword 'weight'"}, parse_obj);
}

/// Decorations with a fault: the surface is read and the fault told; where nobody is told, it is refused.
TEST(ParseObj, DropsDecorationsWithAFault) {
  struct Fault {
    std::string text, notes, reason;
  };
  const std::vector<Fault> table{
      {"v 0 0 0 1 0 0\nv 1 0 0 nan 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n",
       ":2: vertex 1: 'nan' is no number: vertex colors", "'nan' is no number"},
      {"v 0 0 0 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ":1: vertex 0: 5 values in a vertex' line: vertex colors",
       "5 values"},
      {"v 0 0 0 1 0 0 1 1 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
       ":1: vertex 0: the value '1' is one too many in its line: vertex colors", "one too many"},
      {corners + "vn 0 0 inf\nf 1//1 2//1 3//1\n", ":4: normal 0: 'inf' is not a finite number: normals",
       "'inf' is not a finite"},
      {corners + "vn 0 1\nf 1//1 2//1 3//1\n", ":4: normal 0: only 2 values: normals", "only 2"},
      {corners + "vn 0 0 1\nf 1//1 2//2 3//1\n", ":5: face 0: the corner '2//2' names none of 1: normals",
       "names none of 1"},
      {corners + "vt\nf 1/1 2/1 3/1\n", ":4: texture coordinate 0: only 0 values: texture coordinates",
       "only 0"},
      {corners + "vt 1 2 3 4\nf 1/1 2/1 3/1\n",
       ":4: texture coordinate 0: the value '4' is one too many in its line: texture coordinates",
       "too many"},
      {corners + "vt 0 0\nf 1/1 2/-2 3/1\n",
       ":5: face 0: the corner '2/-2' names none of 1: texture coordinates", "names none of 1"},
  };
  for (const Fault& fault : table) {
    SCOPED_TRACE(fault.text);
    const Told read = read_told(fault.text, ".obj");
    expect_same(read.mesh, triangle());
    EXPECT_EQ(read.notes, fault.notes + " dropped\n");
    const std::string line = fault.notes.substr(1, 1);
    expect_refused({fault.text, line, fault.reason}, parse_obj);
  }
}

TEST(RejectObj, Everything) {
  const std::vector<BadFile> table{
      {"", "1", "no vertex"},
      {"# only a comment\n", "1", "no vertex"},
      {"f 1 2 3\n", "1", "no vertex"},
      {"v 0 0\n", "1", "vertex 0: fewer than three coordinates"},
      {"v\n1 2 3\n", "1", "vertex 0: fewer than three coordinates"},
      {"v 0 0 \\\n\nv 1 1 1\n", "1", "vertex 0: fewer than three coordinates"},
      {"v 0 nan 0\n", "1", "vertex 0: coordinate 'nan' is not finite"},
      {"v 0 0 -inf\n", "1", "vertex 0: coordinate '-inf' is not finite"},
      {"v 0 1e400 0\n", "1", "vertex 0: '1e400' is not a number of double precision"},
      {"v 0 1,5 0\n", "1", "vertex 0: '1,5' is not a number"},
      {"v 0 0x1p3 0\n", "1", "vertex 0: '0x1p3' is not a number"},
      {"v 0 1\\\n5 0\n", "1", "'1\\' is not a number"},
      {corners + "f 1 2\n", "4", "face 0: a face of 2 corners"},
      {corners + "f\n", "4", "face 0: a face of 0 corners"},
      {corners + "f 1 2 0\n", "4", "face 0: vertex index in '0'"},
      {corners + "f 1 2 4\n", "4", "face 0: vertex index in '4'"},
      {corners + "f 1 2 3\nf 1 2 \\\n9/1\n", "6", "face 1: vertex index in '9/1'"},
      {corners + "f 1 2 -4\n", "4", "face 0: vertex index in '-4'"},
      {corners + "f 1 2 99999999999999999999\n", "4", "'99999999999999999999' is no corner"},
      {corners + "f 1 2 4294967299\n", "4", "vertex index in '4294967299'"},
      {corners + "f 1 2 -9223372036854775808\n", "4", "vertex index in '-9223372036854775808'"},
      {corners + "f 1 2 3.0\n", "4", "face 0: '3.0' is no corner"},
      {corners + "f 1 2 3/0\n", "4", "face 0: '3/0' is no corner"},
      {corners + "f 1 2 /1\n", "4", "face 0: '/1' is no corner"},
      {corners + "f 1 2 3/1/1/1\n", "4", "face 0: '3/1/1/1' is no corner"},
      {corners + "f 1 2 3\\\n", "4", "is no corner"},
      {corners + "f 1 2 +3\n", "4", "face 0: '+3' is no corner"},
      {corners + "f 1 2 x\n", "4", "face 0: 'x' is no corner"},
      {"\r\n\r\nv 0 0 0\r\nv 0 0\r\n", "4", "vertex 1: fewer"},
      {corners + "call other.obj\n", "4", "unknown keyword 'call'"},
      {std::string("v 0 0 0\0\n", 9), "1", "'0?' is not a number"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_obj);
}

/// Decimal comma, as in much of Europe.
struct CommaInObj : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(ParseObj, DoesNotDependOnTheLocale) {
  const std::string obj = "v 0.5 1.25 1000000\nv 1e-3 0 0\nv 0 1 0\nvt 0.5\nf 1/1 2/1 3/1\n";
  const PolygonMesh mesh = parse_obj(obj, "a");
  const PolygonMesh stl = parse_stl(stl_text(mesh), "a");
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaInObj));
  const PolygonMesh with_comma = parse_obj(obj, "a"), stl_with_comma = parse_stl(stl_text(mesh), "a");
  std::locale::global(before);
  expect_same(with_comma, mesh);
  expect_same(stl_with_comma, stl);
  EXPECT_EQ(mesh.points[0], Vec3(0.5, 1.25, 1e6));
}

}  // namespace
}  // namespace tendril::bind
