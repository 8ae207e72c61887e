// One mesh as OFF, PLY, OBJ and STL, told by content alone: every command does with each what it does with
// the others.

#include <gtest/gtest.h>
#include <tendril/bind/export.h>
#include <tendril/bind/import.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bind/mesh_text.h"
#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;
using bind::PolygonMesh;

/// A closed rod of triangles along y, its coordinates exact in single precision, its points in the order in
/// which faces name them, as STL has them.
PolygonMesh rod() {
  PolygonMesh mesh;
  constexpr std::uint32_t kRound = 12, kRings = 24;
  for (std::uint32_t i = 0; i <= kRings; ++i)
    for (std::uint32_t k = 0; k < kRound; ++k) {
      const double a = 2.0 * M_PI * k / kRound;
      mesh.points.emplace_back(std::round(102.0 * std::cos(a)) / 1024.0, i / 24.0,
                               std::round(102.0 * std::sin(a)) / 1024.0);
    }
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(0, 1, 0);
  for (Vec3& p : mesh.points) p.y() = std::round(1024.0 * p.y()) / 1024.0;
  const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.corners.insert(mesh.corners.end(), {a, b, c});
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  };
  const std::uint32_t low = kRound * (kRings + 1), last = kRound * kRings;
  for (std::uint32_t k = 0; k < kRound; ++k) {
    const std::uint32_t next = (k + 1) % kRound;
    face(low, k, next);
    for (std::uint32_t i = 0; i < kRings; ++i) {
      const std::uint32_t a = i * kRound + k, b = i * kRound + next;
      face(a, a + kRound, b);
      face(b, a + kRound, b + kRound);
    }
    face(last + k, low + 1, last + next);
  }
  return bind::parse_stl(bind::stl_bytes(mesh), "rod");
}

struct Format {
  const char* name;
  std::string bytes;
};

std::vector<Format> formats(const PolygonMesh& mesh) {
  return {{"OFF", bind::off_text(mesh)},
          {"PLY", bind::ply_bytes(mesh)},
          {"OBJ", bind::obj_text(mesh)},
          {"STL, text", bind::stl_text(mesh)},
          {"STL, binary", bind::stl_bytes(mesh, "solid or not")}};
}

constexpr const char* kUpright = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0.1, 0], [0, 0.3, 0], [0, 0.5, 0], [0, 0.7, 0], [0, 0.9, 0]]})";
constexpr const char* kLeaning = R"({"version": 1, "orientation": [0, 0, 1], "points":
  [[0, 0.1, 0], [0, 0.3, 0], [0.05, 0.5, 0], [0.15, 0.67, 0], [0.3, 0.8, 0]]})";

/// What the commands print and write about the mesh in a folder, by what was asked.
std::vector<std::pair<std::string, std::string>> all_commands(const Folder& folder) {
  folder.write("axis.json", kUpright);
  folder.write("pose.json", kLeaning);
  folder.write("queries.json", R"({"version": 1, "points": [[0, 0.5, 0], [1, 0, 0]],
    "balls": [{"centre": [0.2, 0.5, 0], "radius": 0.11}]})");
  const std::string scene =
      R"({"version": 1, "units": {"length": "m", "mass": "kg", "time": "s"}, "mesh": "mesh",
    "bound_to": "stem", "curve_pairs": [{"name": "stem", "points": [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]],
     "orientation": [1, 0, 0], "material": {"young": 2e5, "poisson": 0.4, "density": 1000},
     "section": {"type": "circular", "radius": 0.1}, "anchors": [{"node": 0}]}],
    "bodies": [{"name": "b", "shape": {"type": "mesh", "file": "mesh"}, "position": [2, 0, 0], "axis": [0, 0, 1]}],
    "contact": {"response": "barrier", "range": 0.01, "stiffness": 100},
    "forces": [{"type": "gravity", "acceleration": [1, -9.81, 0]}],
    "simulation": {"duration": 0.02, "tolerance": 1e-3, "frames": 2}})";
  folder.write("scene.json", scene);
  const std::vector<std::array<std::string, 2>> commands{
      {"check mesh --json --strict", ""},
      {"repair mesh --out repaired.off --json", "repaired.off"},
      {"bind mesh --axis axis.json --json", ""},
      {"deform mesh --axis axis.json --pose pose.json --out posed.ply --json", "posed.ply"},
      {"render mesh --out picture.png", "picture.png"},
      {"collide mesh queries.json --json", ""},
      {"collide scene.json queries.json --json", ""},
      {"rig mesh --axis axis.json --out rigged.json", "rigged.json"},
      {"run scene.json --out run --no-pictures", "run/frame_0001.ply"},
      {"statics scene.json --mesh mesh --out still --json", ""},
#ifdef TENDRIL_WITH_AXIS
      {"axis mesh --out found.json", "found.json"},
#endif
  };
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& [command, file] : commands) {
    const Outcome outcome = folder.run(command);
    EXPECT_EQ(outcome.code, 0) << command << ": " << outcome.err;
    const bool timed =
        command.starts_with("run") || command.starts_with("axis") || command.starts_with("statics");
    out.emplace_back(command, file.empty() ? (timed ? std::string() : outcome.out) : bytes_of(folder / file));
    if (!timed) EXPECT_FALSE(out.back().second.empty()) << command;
  }
  return out;
}

TEST(Formats, EveryCommandDoesTheSameWithEach) {
  const PolygonMesh mesh = rod();
  std::vector<std::pair<std::string, std::string>> first;
  for (const Format& format : formats(mesh)) {
    SCOPED_TRACE(format.name);
    const Folder folder;
    folder.write("mesh", format.bytes);
    const auto done = all_commands(folder);
    if (first.empty()) first = done;
    for (std::size_t i = 0; i < done.size(); ++i)
      EXPECT_TRUE(done[i].second == first[i].second) << done[i].first << '\n'
                                                     << done[i].second.substr(0, 400);
  }
}

TEST(Formats, RunTakesMeshesOfEveryName) {
  const PolygonMesh mesh = rod();
  const Folder folder;
  for (const char* name : {"rod.obj", "rod.STL"}) {
    folder.write(name, name[4] == 'o' ? bind::obj_text(mesh) : bind::stl_bytes(mesh));
    const Outcome outcome = folder.run(std::string("run ") + name + " --out " + name + "-run --no-pictures");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_FALSE(bytes_of(folder / (std::string(name) + "-run/frame_0001.ply")).empty());
  }
}

/// Seams and all, through a pose and through repair.
TEST(Formats, TextureCoordinatesSurvive) {
  const Folder folder;
  const PolygonMesh mesh = rod();
  std::string obj;
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) obj += "vt 0." + std::to_string(c) + " 0.5\n";
  std::string faces = bind::obj_text(mesh);
  obj += faces.substr(0, faces.find("\nf") + 1);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    obj += 'f';
    for (std::size_t c = mesh.face_begin[f]; c < mesh.face_begin[f + 1]; ++c)
      obj += ' ' + std::to_string(mesh.corners[c] + 1) + '/' + std::to_string(c + 1);
    obj += '\n';
  }
  const std::string file = folder.write("rod.obj", obj);
  folder.write("axis.json", kUpright);
  folder.write("pose.json", kLeaning);
  const PolygonMesh read = bind::read_mesh(file);
  ASSERT_EQ(read.corner_texture.size(), mesh.corners.size());
  EXPECT_EQ(read.corner_texture[17], (bind::TextureCoordinate{0.17, 0.5}));
  ASSERT_EQ(folder.run("deform rod.obj --axis axis.json --pose pose.json --out posed.ply").code, 0);
  EXPECT_EQ(bind::read_mesh(folder / "posed.ply").corner_texture, read.corner_texture);
  ASSERT_EQ(folder.run("repair rod.obj --out same.ply").code, 0);
  EXPECT_EQ(bind::read_mesh(folder / "same.ply").corner_texture, read.corner_texture);
  const Outcome lost = folder.run("deform rod.obj --axis axis.json --pose pose.json --out posed.off");
  EXPECT_EQ(lost.code, 0);
  EXPECT_NE(lost.err.find("posed.off: OFF has no place for texture coordinates of corners"),
            std::string::npos)
      << lost.err;
}

TEST(Formats, RefusesMalformedOnesWithPlaceByEveryCommand) {
  const Folder folder;
  folder.write("axis.json", kUpright);
  folder.write("queries.json", R"({"version": 1, "points": [[0, 0, 0]]})");
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
  folder.write("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n");
  for (const std::string command :
       {"check %", "repair % --out r.off", "bind % --axis axis.json", "render % --out a.png",
        "rig % --out s.json", "deform % --axis axis.json --pose axis.json --out d.ply",
        "collide % queries.json"})
    for (const auto& [name, place] : {std::pair{"a.obj", "a.obj:4: face 0: vertex index in '7'"},
                                      {"a.stl", "a.stl:4: facet 0: coordinate 'nan'"}}) {
      std::string line = command;
      const Outcome outcome = folder.run(line.replace(line.find('%'), 1, name));
      EXPECT_EQ(outcome.code, 2) << line;
      EXPECT_NE(outcome.err.find(place), std::string::npos) << line << ": " << outcome.err;
    }
}

}  // namespace
}  // namespace tendril::test
