#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/base/file.h>
#include <tendril/bind/import.h>

#include <limits>
#include <locale>

#include "mesh_text.h"

namespace tendril::bind {
namespace {

/// The tetrahedron's points and faces as OFF lines, each ended by `end`.
std::string off_lines(const std::string& end) {
  std::string text;
  for (const char* line : {"0 0 0", "1 0 0", "0 1 0", "0 0 1", "3 0 2 1", "3 0 1 3", "3 1 2 3", "3 2 0 3"}) {
    text += line + end;
  }
  return text;
}

TEST(ParseOff, AcceptsEveryWayToWriteTheSame) {
  const std::string body = off_lines("\n");
  const std::vector<std::string> variants{
      "OFF\n4 4 6\n" + body,
      "OFF 4 4 0\n" + body,
      "OFF\r\n4 4 0\r\n" + off_lines("\r\n"),
      "OFF\r4 4 0\r" + off_lines("\r"),
      "# first\n\n  # second\nOFF # third\n\n4 4 0#fourth\n\n" + off_lines("   # fifth\n\n"),
      "\xEF\xBB\xBFOFF\n4 4 0\n" + body,
      "OFF\n4 4 0\n" + body.substr(0, body.size() - 1),
      "OFF\n4 4 0\n" + body + "\n \t\n# the end",
      "OFF\n4 4 0\n0 0 0 1 0 0\n0 1 0\n0 0\n1\n3 0 2 1\n3 0 1\n3\n3 1 2 3\n3 2 0 3",
      "OFF\n4 4 0\n+0 0. .0\n1e0 0 0\n0 10E-1 0\n\t0 0e5 0.1e+1\v\n3.0 0 2e0 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
  };
  for (const std::string& text : variants) {
    SCOPED_TRACE(text);
    expect_same(parse_off(text, "a.off"), tetrahedron());
  }
}

TEST(ParseOff, ReadsNumbersToTheLastBit) {
  const auto mesh =
      parse_off("OFF 2 0 0\n0.1 1e-320 -0\n1.7976931348623157e308 4.9406564584124654e-324 3\n", "a");
  using Doubles = std::numeric_limits<double>;
  EXPECT_EQ(bits(mesh.points), bits({{0.1, 1e-320, -0.0}, {Doubles::max(), Doubles::denorm_min(), 3}}));
  EXPECT_EQ(mesh.face_begin, std::vector<std::uint32_t>{0});
}

TEST(ParseOff, AcceptsAnEmptyMeshARepeatedVertexAndALargePolygon) {
  expect_same(parse_off("OFF\n0 0 0\n", "a"), PolygonMesh{});
  const auto repeated = parse_off("OFF\n2 1 0\n0 0 0 1 1 1\n3 0 1 1\n", "a");
  EXPECT_EQ(repeated.corners, (std::vector<std::uint32_t>{0, 1, 1}));
  std::string text = "OFF 1 1 0 0 0 0\n100000";
  for (int i = 0; i < 100000; ++i) text += " 0";
  EXPECT_EQ(parse_off(text, "a").corners.size(), 100000);
}

TEST(ParseOff, ReadsTextureCoordinates) {
  const std::vector<TextureCoordinate> texture{{.1, .2}, {.3, .4}, {.5, .6}};
  const std::string plain = "STOFF 3 1 0\n0 0 0 .1 .2\n1 0 0 .3 .4\n0 1 0 .5 .6\n3 0 1 2";
  EXPECT_EQ(parse_off(plain, "a.off").point_texture, texture);
  const std::string colored =
      "STCOFF 3 1 0\n0 0 0 255 0 0 .1 .2\n1 0 0 255 0 0 255 .3 .4\n0 1 0 255 0 0 .5 .6\n3 0 1 2";
  EXPECT_EQ(parse_off(colored, "a.off").point_texture, texture);
}

struct OffAttributes {
  const char* text;
  std::vector<Vec3> normals;
  std::vector<Color> point_colors, face_colors;
};

TEST(ParseOff, ReadsPrefixesAndColors) {
  const Color red{255, 0, 0, 255}, grey{170, 170, 170, 255};
  const std::vector<Vec3> up(3, Vec3(0, 0, 1));
  const std::vector<OffAttributes> cases{
      {"NOFF 3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2", up, {}, {}},
      {"COFF 3 1 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0 128\n3 0 1 2",
       {},
       {red, red, {255, 0, 0, 128}},
       {}},
      {"COFF 3 1 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0.4\n3 0 1 2",
       {},
       {red, red, {255, 0, 102, 255}},
       {}},
      {"CNOFF 3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 255 0 0\n0 1 0 0 0 1 255 0 0\n3 0 1 2",
       up,
       {red, red, red},
       {}},
      {"NCOFF 3 1 0\n0 0 0 0 0 1 1.0 0 0\n1 0 0 0 0 1 1 0 0\n0 1 0 0 0 1 1 0 0 1\n3 0 1 2",
       up,
       {red, red, red},
       {}},
      {"STOFF 3 1 0\n0 0 0 .1 .2\n1 0 0 .3 .4\n0 1 0 .5 .6\n3 0 1 2", {}, {}, {}},
      {"STCNOFF 3 1 0\n0 0 0 0 0 1 255 0 0 .1 .2\n1 0 0 0 0 1 255 0 0 255 .3 .4\n0 1 0 0 0 1 255 0 0 .5 "
       ".6\n3 0 1 2",
       up,
       {red, red, red},
       {}},
      {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0 # red", {}, {}, {red}},
      {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1. 0 0 1", {}, {}, {red}},
      {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7", {}, {}, {}},
      {"OFF 3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2 255 0 0\n3 0 1 2 4", {}, {}, {grey, red, grey}},
      {"OFF 3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 0 0\n3 0 1 2 .5 0 0", {}, {}, {red, {128, 0, 0, 255}}},
      {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 0 0", {}, {}, {{1, 0, 0, 255}}},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.text);
    const PolygonMesh mesh = parse_off(c.text, "a.off");
    EXPECT_EQ(bits(mesh.points), bits({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(bits(mesh.point_normals), bits(c.normals));
    EXPECT_EQ(mesh.point_colors, c.point_colors);
    EXPECT_EQ(mesh.face_colors, c.face_colors);
  }
}

TEST(ParseOff, ReadsBinary) {
  Bytes file("STCNOFF BINARY\n", true);
  file.put(3, 2, 99);
  for (int v = 0; v < 3; ++v) {
    file.put(0.5F, static_cast<float>(v), -1.0F)
        .put(0.0F, 0.0F, 1.0F)
        .put(1.0F, 0.0F, 0.0F, 0.5F)
        .put(0.1F, 0.2F);
  }
  file.put(3, 0, 1, 2, 3).put(0.0F, 1.0F, 0.0F).put(4, 0, 1, 2, 0, 0);
  PolygonMesh expected = mesh_of({{0.5, 0, -1}, {0.5, 1, -1}, {0.5, 2, -1}}, {{0, 1, 2}, {0, 1, 2, 0}});
  expected.point_normals.assign(3, Vec3(0, 0, 1));
  expected.point_colors.assign(3, {255, 0, 0, 128});
  expected.face_colors = {{0, 255, 0, 255}, {170, 170, 170, 255}};
  expected.point_texture.assign(3, {static_cast<double>(0.1F), static_cast<double>(0.2F)});
  expect_same(parse_off(file.str(), "a.off"), expected);
}

const char* const ply_points = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const char* const ply_faces = "element face 4\nproperty list uchar int vertex_indices\n";

std::string ply_text(const std::string& end) {
  std::string text =
      std::string("ply\nformat ascii 1.0\n") + ply_points + ply_faces + "end_header\n" + off_lines("\n");
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
    text.replace(at, 1, end);
  return text;
}

TEST(ParsePly, AcceptsEveryWayToWriteTheSame) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string plain = ply_text("\n");
  const std::vector<std::string> variants{
      plain,
      ply_text("\r\n"),
      ply_text("\r"),
      ply_text("\n\n"),
      ply_text(" \t\n"),
      "\xEF\xBB\xBF" + plain,
      plain.substr(0, plain.size() - 1),
      "ply\ncomment a # b\nobj_info made by\ncomment\nformat ascii 1.0\n" + plain.substr(head.size()),
      head + ply_faces + ply_points + "end_header\n" + off_lines("\n").substr(24) +
          off_lines("\n").substr(0, 24),
      head + "element empty 99999999999999\n" + plain.substr(head.size()),
      head + "element a 2\nproperty list uchar float v\nproperty char c\n" + ply_points +
          "element edge 1\nproperty int p\nproperty int q\n" + ply_faces +
          "end_header\n2 nan 1\n7\n0 word\n" + off_lines("\n").substr(0, 24) + "5 6\n" +
          off_lines("\n").substr(24),
  };
  for (const std::string& text : variants) {
    SCOPED_TRACE(text);
    expect_same(parse_ply(text, "a.ply"), tetrahedron());
  }
}

TEST(ParsePly, SkipsExtraPropertiesAndReadsAttributes) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar blue\nproperty list uchar int history\n"
      "property double z\nproperty int id\nproperty float nx\nproperty double y\nproperty uchar red\n"
      "property float ny\nproperty int x\nproperty float nz\nproperty uchar green\n"
      "element face 2\nproperty float quality\nproperty float alpha\nproperty float red\nproperty float "
      "green\n"
      "property float blue\nproperty list ushort uint64 vertex_index\nproperty list char double "
      "extra\nend_header\n"
      "3 2 8 9 0.5 77 0 4 1 0 -1 1 2\n3 0 1.5 77 0 5 1 0 -2 1 2\n3 1 4 2.5 77 0 6 1 0 -3 1 2\n"
      "nan 0.5 1 0 0 3 0 1 2 0\n1 1 0 0.2 0 3 2 1 0 2 1 1\n";
  PolygonMesh expected = mesh_of({{-1, 4, 0.5}, {-2, 5, 1.5}, {-3, 6, 2.5}}, {{0, 1, 2}, {2, 1, 0}});
  expected.point_normals.assign(3, Vec3(0, 0, 1));
  expected.point_colors.assign(3, {1, 2, 3, 255});
  expected.face_colors = {{255, 0, 0, 128}, {0, 51, 0, 255}};
  expect_same(parse_ply(text, "a.ply"), expected);
}

TEST(ParsePly, ReadsTextureCoordinatesOfPointsAndCorners) {
  for (const auto& [s, t] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::string text = std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n") +
                             "property float y\nproperty float " + t + "\nproperty float " + s +
                             "\nproperty float z\nelement face 1\nproperty list uchar float texcoord\n" +
                             "property list uchar int vertex_indices\nproperty int texnumber\nend_header\n" +
                             "0 0 .2 .1 0\n1 0 .4 .3 0\n0 1 .6 .5 0\n6 1 2 3 4 5 6 3 0 1 2 0\n";
    PolygonMesh expected = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    expected.point_texture = {{.1, .2}, {.3, .4}, {.5, .6}};
    expected.corner_texture = {{1, 2}, {3, 4}, {5, 6}};
    expect_same(parse_ply(text, "a.ply"), expected);
    // One alone is of no use, and a list that does not fit is none.
    std::string part = text;
    part.replace(part.find(std::string("float ") + t), 6 + std::string(t).size(), "float other");
    expected.point_texture.clear();
    expect_same(parse_ply(part, "a.ply"), expected);
    part = text;
    part.replace(part.find("6 1 2"), 11, "3 1 2 3");
    EXPECT_THROW(parse_ply(part, "a.ply"), InvalidInput);
  }
}

TEST(ParsePly, IgnoresAPartOfANormalOrColor) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float red\nproperty int alpha\nend_header\n1 2 3 nan 700 -1\n";
  expect_same(parse_ply(text, "a.ply"), mesh_of({{1, 2, 3}}, {}));
}

template <class Count, class Index>
void expect_list_type(const std::string& count, const std::string& index) {
  for (const bool big : {false, true}) {
    SCOPED_TRACE(count + " " + index + (big ? " big" : " little"));
    Bytes file(std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + ply_points +
                   "element face 2\nproperty list " + count + " " + index + " vertex_indices\nend_header\n",
               big);
    for (const Vec3& p : house().points)
      file.put(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.25F);
    std::string bytes = file.str();
    bytes.replace(bytes.find("vertex 4"), 8, "vertex 5");
    Bytes whole(bytes, big);
    whole.put(Count{4}, Index{0}, Index{1}, Index{2}, Index{3}).put(Count{3}, Index{3}, Index{2}, Index{4});
    PolygonMesh expected = house();
    for (Vec3& p : expected.points) p.z() = 0.25;
    expect_same(parse_ply(whole.str(), "a.ply"), expected);
  }
}

template <class Count>
void expect_index_types(const std::string& count) {
  expect_list_type<Count, std::int8_t>(count, "char");
  expect_list_type<Count, std::uint8_t>(count, "uint8");
  expect_list_type<Count, std::int16_t>(count, "int16");
  expect_list_type<Count, std::uint16_t>(count, "ushort");
  expect_list_type<Count, std::int32_t>(count, "int");
  expect_list_type<Count, std::uint32_t>(count, "uint32");
  expect_list_type<Count, std::int64_t>(count, "int64");
  expect_list_type<Count, std::uint64_t>(count, "uint64");
  expect_list_type<Count, float>(count, "float32");
  expect_list_type<Count, double>(count, "double");
}

TEST(ParsePly, ReadsEveryListTypeInBothByteOrders) {
  expect_index_types<std::int8_t>("int8");
  expect_index_types<std::uint8_t>("uchar");
  expect_index_types<std::int16_t>("short");
  expect_index_types<std::uint16_t>("uint16");
  expect_index_types<std::int32_t>("int32");
  expect_index_types<std::uint32_t>("uint");
  expect_index_types<std::int64_t>("int64");
  expect_index_types<std::uint64_t>("uint64");
}

TEST(ParsePly, ReadsEveryScalarTypeAsCoordinate) {
  for (const bool big : {false, true}) {
    Bytes file(std::string("ply\nformat binary_") + (big ? "big" : "little") +
                   "_endian 1.0\nelement vertex 1\nproperty char a\nproperty short x\nproperty uint16 "
                   "b\nproperty int64 y\n"
                   "property list uint16 double skipped\nproperty double z\nend_header\n",
               big);
    file.put(std::int8_t{-1}, std::int16_t{-300}, std::uint16_t{9}, std::int64_t{1} << 40);
    file.put(std::uint16_t{2}, 1.0, 2.0, -1e-310);
    expect_same(parse_ply(file.str(), "a.ply"), mesh_of({{-300, 1099511627776.0, -1e-310}}, {}));
  }
}

TEST(ParsePly, FindsTheFirstByteOfTheDataAfterAnyLineEnd) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string head =
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\n"
        "property uchar z\nend_header\n";
    for (std::size_t at = 0; (at = head.find('\n', at)) != head.npos; at += end.size())
      head.replace(at, 1, end);
    expect_same(parse_ply(head + "\n\r ", "a.ply"),
                mesh_of({{10, 13, 32}}, {}));  // data that looks like line ends
  }
}

TEST(ReadMesh, ChoosesTheFormatByContent) {
  const std::string path = testing::TempDir() + "tendril-import-" + std::to_string(::getpid()) + ".ply";
  for (const std::string& bytes : {ply_text("\n"), "# a comment\nOFF\n4 4 0\n" + off_lines("\n")}) {
    write_file_whole(path, bytes);
    expect_same(read_mesh(path), tetrahedron());
  }
  for (const std::string& bytes :
       {obj_text(tetrahedron()), "# comment\nmtllib a.mtl\n" + obj_text(tetrahedron())}) {
    write_file_whole(path, bytes);
    expect_same(read_mesh(path), tetrahedron());
  }
  // Points of STL are in the order in which they appear.
  const PolygonMesh triangle = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (const std::string& bytes :
       {stl_bytes(triangle), stl_bytes(triangle, "solid"), stl_bytes(triangle, "OFF"), stl_text(triangle)}) {
    write_file_whole(path, bytes);
    expect_same(read_mesh(path), triangle);
  }
  for (const std::string bytes : {"", " \n# OFF\n", "solid a\n", "4 4 0\n", "hello v 0 0 0\n"}) {
    write_file_whole(path, bytes);
    EXPECT_THROW(read_mesh(path), InvalidInput) << bytes;
  }
  std::remove(path.c_str());
  EXPECT_THROW(read_mesh(path), FileError);
}

TEST(ReadMesh, ChoosesByNameWhereTheContentDoesNotTell) {
  const std::string path = testing::TempDir() + "tendril-named-" + std::to_string(::getpid());
  const std::string odd = "made_by somebody\n" + obj_text(tetrahedron());
  std::vector<std::string> notes;
  write_file_whole(path + ".OBJ", odd);
  expect_same(read_mesh(path + ".OBJ", &notes), tetrahedron());
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("'made_by'"), std::string::npos) << notes[0];
  write_file_whole(path + ".ply", odd);
  EXPECT_THROW(read_mesh(path + ".ply", &notes), InvalidInput);
  const PolygonMesh triangle = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  notes.clear();
  write_file_whole(path + ".stl", stl_bytes(triangle) + "more");
  expect_same(read_mesh(path + ".stl", &notes), triangle);
  EXPECT_EQ(notes.size(), 1u);
  for (const char* end : {".OBJ", ".ply", ".stl"}) std::remove((path + end).c_str());
}

/// Decimal comma and grouped thousands, as in much of Europe.
struct CommaFacet : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Parse, DoesNotDependOnTheLocale) {
  const std::string off = "OFF\n3 1 0\n0.5 1.25 1000000\n1e-3 0 0\n0 1 0\n3 0 1 2 0.5 0 0\n";
  const PolygonMesh mesh = parse_off(off, "a.off");
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaFacet));
  const PolygonMesh with_comma = parse_off(off, "a.off");
  const PolygonMesh from_ply = parse_ply(ply_text("\n"), "a.ply");
  EXPECT_THROW(parse_off("OFF\n1 0 0\n0,5 1 1\n", "a.off"), InvalidInput);
  std::locale::global(before);
  expect_same(with_comma, mesh);
  expect_same(from_ply, tetrahedron());
  EXPECT_EQ(mesh.points[0], Vec3(0.5, 1.25, 1e6));
}

}  // namespace
}  // namespace tendril::bind
