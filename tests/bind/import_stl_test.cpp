#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/import.h>

#include <limits>

#include "mesh_notes.h"

namespace tendril::bind {
namespace {

/// The tetrahedron with its points in the order in which its faces name them.
PolygonMesh by_appearance() {
  return mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ParseStl, AcceptsEveryWayToWriteTheSame) {
  const std::string text = stl_text(tetrahedron());
  std::string upper = text;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  std::string one_line = text;
  for (std::size_t at = one_line.find('\n') + 1; (at = one_line.find('\n', at)) != one_line.npos;)
    one_line[at] = ' ';
  const std::size_t half = text.find("  facet", text.size() / 2);
  const std::vector<std::string> variants{
      text,
      upper,
      one_line,
      stl_text(tetrahedron(), "\r\n"),
      stl_text(tetrahedron(), "\r"),
      stl_text(tetrahedron(), " \t\n\n"),
      "\xEF\xBB\xBF" + text,
      text.substr(0, text.size() - 1),
      replaced(text, "solid of a name\n", "solid\n"),
      text.substr(0, half) + "endsolid\n\nsolid facet normal\n" + text.substr(half),  // two of them
      replaced(text, "vertex 0 0 0", "vertex -0.0 +0 0e9"),
  };
  for (const std::string& one : variants) {
    SCOPED_TRACE(one);
    PolygonMesh mesh = parse_stl(one, "a.stl");
    for (Vec3& p : mesh.points) p += Vec3::Zero();  // -0 to 0
    expect_same(mesh, by_appearance());
  }
}

TEST(ParseStl, ReadsBinaryWhateverItsHeaderSays) {
  for (const char* header : {"made here", "solid", "solid facet normal 0 0 0", "OFF", "ply", "# v 0 0 0"})
    expect_same(parse_stl(stl_bytes(tetrahedron(), header), "a.stl"), by_appearance());
  const std::string zero = stl_bytes(PolygonMesh{});
  expect_same(parse_stl(zero, "a.stl"), PolygonMesh{});
  expect_same(parse_stl("solid a\nendsolid a\n", "a.stl"), PolygonMesh{});
}

TEST(ParseStl, ReadsTextToTheLastBitOfDoubles) {
  const PolygonMesh mesh = mesh_of({{0.1, 1e-320, 1e308}, {0.3, -1e-7, 2}, {1.0 / 3, 0, 1}}, {{0, 1, 2}});
  expect_same(parse_stl(stl_text(mesh), "a"), mesh);
}

/// Exactly: a neighbour of a number is another point, and subnormal numbers are not 0.
TEST(ParseStl, MergesPointsAtExactlyTheSamePlace) {
  const double next = std::nextafter(1.0, 2.0), tiny = std::numeric_limits<double>::denorm_min();
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {next, 0, 0}, {tiny, 0, 0}},
                                   {{0, 1, 2}, {0, 3, 2}, {4, 1, 2}});
  expect_same(parse_stl(stl_text(mesh), "a"), mesh);
  const PolygonMesh zeros = parse_stl(
      stl_text(mesh_of({{0.0, -0.0, 1}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0.0, 1}}, {{0, 1, 2}, {3, 2, 1}})), "a");
  EXPECT_EQ(zeros.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 1}));
}

TEST(ParseStl, MergesManyPoints) {
  PolygonMesh mesh;
  for (std::uint32_t i = 0; i < 90000; ++i) {
    mesh.corners.push_back(i);
    mesh.points.emplace_back(i % 100, i / 100 % 30, 0.5);
    if (i % 3 == 2) mesh.face_begin.push_back(i + 1);
  }
  const PolygonMesh read = parse_stl(stl_bytes(mesh), "a");
  EXPECT_EQ(read.points.size(), 3000u);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c)
    ASSERT_EQ(read.points[read.corners[c]], mesh.points[mesh.corners[c]]);
}

TEST(ParseStl, NamesWhatIsOdd) {
  const std::string text = stl_text(by_appearance());
  struct Odd {
    std::string bytes, notes;
  };
  std::string colored = stl_bytes(tetrahedron());
  colored[84 + 48] = 7;
  colored[84 + 3 * 50 + 49] = 1;
  const std::string repeated = stl_text(mesh_of({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}, {0, 1, 0}}));
  const std::vector<Odd> table{
      {text, ""},
      {replaced(text, "normal 0 0 0", "normal 0 0 -1"), ""},  // as its corners have it
      {replaced(text, "normal 0 0 0", "normal 0 0.5 1"),
       ": facet 0: its normal points against the order of its corners, which counts\n"},
      {replaced(text, "normal 0 0 0", "normal -nan(ind) 0 1.#QNAN"),
       ": facet 0: a normal that is not finite; it is not used\n"},
      {replaced(text, "normal 0 0 0", "normal 1 -1 0"), ""},  // across
      {colored, ": facet 0: attribute bytes, a color perhaps, not read (and 1 more)\n"},
  };
  for (const Odd& odd : table) {
    SCOPED_TRACE(odd.notes);
    const Told read = read_told(odd.bytes, ".stl");
    expect_same(read.mesh, by_appearance());
    EXPECT_EQ(read.notes, odd.notes);
    expect_same(parse_stl(odd.bytes, "a"), by_appearance());
  }
  const Told read = read_told(repeated, ".stl");
  EXPECT_EQ(read.mesh.corners, (std::vector<std::uint32_t>{0, 1, 1, 0, 1, 0}));
  EXPECT_EQ(read.notes, ": facet 0: two corners at one place (and 1 more)\n");
}

TEST(RejectStl, Text) {
  const std::string text = stl_text(tetrahedron());
  const auto with = [&](const std::string& from, const std::string& to) { return replaced(text, from, to); };
  const std::vector<BadFile> table{
      {"solid a\n", "2", "facet 0: the file ends"},
      {"solid", "1", "facet 0: the file ends"},
      {with("vertex 0 0 0", "vertex 0 nan 0"), "4", "facet 0: coordinate 'nan' is not finite"},
      {with("vertex 0 0 0", "vertex 0 inf 0"), "4", "facet 0: coordinate 'inf' is not finite"},
      {with("vertex 0 0 0", "vertex 0 1e400 0"), "4", "'1e400' is not a number of double precision"},
      {with("vertex 0 0 0", "vertex 0 0,5 0"), "4", "'0,5' is not a number"},
      {with("vertex 0 0 0", "vertex 0 0"), "5", "'vertex' is not a number"},
      {with("      vertex 0 0 0\n", ""), "6", "facet 0: the word 'endloop'"},
      {with("    endloop\n", "vertex 1 1 1\nendloop\n"), "7", "facet 0: the word 'vertex'"},
      {with("    endloop\n", ""), "7", "facet 0: the word 'endfacet'"},
      {with("outer loop", "inner loop"), "3", "facet 0: the word 'inner'"},
      {with("facet normal", "facet"), "2", "facet 0: the word '0'"},
      {with("facet normal 0 0 0", "color 1 0 0"), "2", "facet 0: the word 'color'"},
      {with("endsolid of a name\n", ""), "30", "facet 4: the file ends"},
      {text + "more\n", "31", "the word 'more'"},
      {text + "solid b\n", "32", "facet 4: the file ends"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_stl);
}

TEST(RejectStl, Binary) {
  const std::string good = stl_bytes(tetrahedron());
  const auto with = [&](std::size_t at, float value) {
    return good.substr(0, at) + Bytes("", false).put(value).str() + good.substr(at + 4);
  };
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<BadFile> table{
      {"", "byte 0", "header: the file ends here, 0 bytes"},
      {good.substr(0, 82), "byte 80", "header: the file ends here, 2 bytes are left"},
      {good.substr(0, 283), "byte 84", "header: the file ends here, 199 bytes are left"},
      {stl_bytes(tetrahedron(), "solid").substr(0, 283), "byte 84", "199 bytes are left"},
      {good + "x", "byte 284", "1 bytes are left over"},
      {with(84 + 12, inf), "byte 96", "facet 0: coordinate inf is not finite"},
      {with(84 + 150 + 44, std::numeric_limits<float>::quiet_NaN()), "byte 278", "facet 3: coordinate nan"},
      {with(80, inf), "byte 80", "more than 2^32 - 1 corners"},
      {with(80, 1.0F), "byte 84", "the file ends here, 200 bytes are left"},
  };
  for (const BadFile& bad : table) expect_refused(bad, parse_stl);
  EXPECT_EQ(read_told(good + "x", ".stl").notes,
            ":byte 282: after the last facet: 1 bytes are left over, not read\n");
}

}  // namespace
}  // namespace tendril::bind
