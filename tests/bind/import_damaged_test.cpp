// OBJ and STL files cut short or damaged at random: a valid mesh or a refusal, never anything else. The other
// formats are damaged in import_reject_test.cpp; fuzz.sh does all of it guided by coverage.

#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>

#include <random>

#include "mesh_notes.h"

namespace tendril::bind {
namespace {

using Parse = PolygonMesh (*)(std::string_view, const std::string&);

/// \return  whether the bytes were refused
bool refused(const std::string& bytes, Parse parse) {
  // An own copy of just these bytes, so that a sanitizer sees any read beyond them.
  const std::vector<char> copy(bytes.begin(), bytes.end());
  PolygonMesh mesh;
  try {
    mesh = parse(std::string_view(copy.data(), copy.size()), "damaged");
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(error.place().starts_with("damaged:")) << error.what();
    EXPECT_FALSE(error.expected().empty());
    return true;
  }
  require_valid(mesh);
  return false;
}

const std::string full =
    "v 0 0 0 1 0 0\nv 1 0 0 1 0 0 1\nv 0 1 0 0 1 0 # c\nv 1 1 0.5\nvn 0 0 1\nvn 0 1 0\nvt 0 0.5\nvt 1\n"
    "f 1/1/1 2/2/1 3/-1/-1\nf 1//1 \\\n 2//1 4//2\ng a\nusemtl b\nl 1 2\nf -1 -2 -3 -4\n";

/// Numbers and words that readers stumble over.
const std::vector<std::string> kWords{"nan",
                                      "-inf",
                                      "1e400",
                                      "1e-400",
                                      "4294967296",
                                      "-9223372036854775808",
                                      "18446744073709551616",
                                      "0",
                                      "-1",
                                      "f",
                                      "v",
                                      "vn",
                                      "vt",
                                      "/",
                                      "//",
                                      "\\\n",
                                      "#",
                                      "\r",
                                      "\n",
                                      "\\",
                                      "solid",
                                      "facet",
                                      "endsolid",
                                      "endloop",
                                      "vertex",
                                      "\xEF\xBB\xBF",
                                      std::string(1, '\0'),
                                      "\xFF\xFF\xFF\xFF",
                                      "1e308",
                                      "0.1"};

std::string damaged(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t k = 1 + below(4); k > 0; --k) {
    const std::size_t at = below(bytes.size());
    switch (below(5)) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes.insert(at, kWords[below(kWords.size())]);
        break;
      case 2:
        bytes.replace(at, below(8), kWords[below(kWords.size())]);
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(60)));
        break;
      default:
        bytes.erase(at, below(12));
    }
  }
  return bytes;
}

TEST(DamagedFiles, GiveAValidMeshOrARefusal) {
  std::mt19937 random(11);
  const std::vector<std::pair<std::string, Parse>> files{{full, parse_obj},
                                                         {stl_text(tetrahedron()), parse_stl},
                                                         {stl_bytes(tetrahedron(), "solid"), parse_stl}};
  for (const auto& [whole, parse] : files) {
    ASSERT_FALSE(refused(whole, parse));
    std::size_t count = 0;
    constexpr std::size_t inputs = 35000;  // of each, 10^5 in all
    for (std::size_t i = 0; i < inputs; ++i) count += refused(damaged(whole, random), parse);
    EXPECT_GT(count, inputs / 10);
    EXPECT_LT(count, inputs);
  }
}

TEST(DamagedFiles, OfStlAreRefusedWhereTheyAreCut) {
  for (const std::string& whole : {stl_text(tetrahedron()), stl_bytes(tetrahedron())}) {
    const std::size_t name = whole.starts_with("solid") ? std::string(" of a name\n").size() : 0;
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_EQ(refused(whole.substr(0, size), parse_stl), size + name < whole.size()) << size;
  }
}

/// There are no counts: what is cut is a smaller mesh, or none.
TEST(DamagedFiles, OfObjGiveABeginningWhereTheyAreCut) {
  const PolygonMesh mesh = parse_obj(full, "whole");
  for (std::size_t size = 0; size < full.size(); ++size) {
    PolygonMesh part;
    try {
      part = parse_obj(full.substr(0, size), "cut");
    } catch (const InvalidInput&) {
      continue;
    }
    EXPECT_LE(part.points.size(), mesh.points.size());
    EXPECT_LE(part.face_count(), mesh.face_count());
  }
}

/// One mesh through all formats: the same points, faces and attributes, or for STL the same triangles.
TEST(AllFormats, GiveTheSameMesh) {
  std::mt19937 random(5);
  PolygonMesh mesh;
  for (int i = 0; i < 200; ++i)
    mesh.points.emplace_back(0.25 * (i % 7), 0.125 * (i % 5), static_cast<float>(i) * 0.37F);
  for (std::uint32_t f = 0; f < 300; ++f) {
    for (int k = 0; k < 3; ++k) mesh.corners.push_back(static_cast<std::uint32_t>(random() % 200));
    mesh.face_begin.push_back(3 * f + 3);
  }
  expect_same(parse_off(off_text(mesh), "a"), mesh);
  expect_same(parse_ply(ply_bytes(mesh), "a"), mesh);
  expect_same(parse_obj(obj_text(mesh), "a"), mesh);
  const PolygonMesh stl = parse_stl(stl_bytes(mesh), "a");
  expect_same(parse_stl(stl_text(mesh), "a"), stl);
  ASSERT_EQ(stl.face_begin, mesh.face_begin);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c)
    EXPECT_EQ(stl.points[stl.corners[c]], mesh.points[mesh.corners[c]]);
}

}  // namespace
}  // namespace tendril::bind
