#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/bind/export.h>
#include <tendril/scene/scene_file.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "axis/shapes.h"
#include "rig/rig.h"
#include "runner/program.h"
#include "support/numbers.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;
using bind::PolygonMesh;
using runner::RigCurve;

using tendril::test::kPi;

/// A closed prism along x from 0 to `length` over a polygon in the y, z plane, in `rings` equal pieces.
PolygonMesh prism(const std::vector<Eigen::Vector2d>& outline, double length, std::uint32_t rings) {
  PolygonMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  const auto face = [&](std::vector<std::uint32_t> corners) {
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  };
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (const Eigen::Vector2d& p : outline) mesh.points.emplace_back(length * i / rings, p.x(), p.y());
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t k = 0; k < n; ++k)
      face({i * n + k, i * n + (k + 1) % n, (i + 1) * n + (k + 1) % n, (i + 1) * n + k});
  std::vector<std::uint32_t> first, last;
  for (std::uint32_t k = 0; k < n; ++k) first.push_back(n - 1 - k), last.push_back(rings * n + k);
  face(first);
  face(last);
  return mesh;
}

std::vector<Eigen::Vector2d> ellipse_outline(double a, double b, double turn, int corners) {
  std::vector<Eigen::Vector2d> out;
  for (int k = 0; k < corners; ++k) {
    const double s = 2 * kPi * k / corners;
    out.emplace_back(Eigen::Rotation2Dd(turn) * Eigen::Vector2d(a * std::cos(s), b * std::sin(s)));
  }
  return out;
}

/// Along x, with l along -z... m towards y: l = m x t = y x x = -z.
RigCurve straight(double from, double to, std::size_t nodes) {
  RigCurve curve{"axis", {}, {}};
  for (std::size_t i = 0; i < nodes; ++i) {
    const double x = from + (to - from) * static_cast<double>(i) / static_cast<double>(nodes - 1);
    curve.points.emplace_back(x, 0, 0);
    curve.orientation.emplace_back(x, 0.5, 0);
  }
  return curve;
}

/// Four legs, a neck and a tail end: a capsule each.
PolygonMesh animal() {
  const Field field = [](const Vec3& p) {
    double least = capsule_field(p, Vec3(-1, 0.9, 0), Vec3(0.9, 0.9, 0), 0.22);
    least = std::min(least, capsule_field(p, Vec3(0.8, 0.95, 0), Vec3(1.4, 1.6, 0), 0.13));
    for (const double x : {-0.7, 0.7})
      for (const double z : {-0.35, 0.35})
        least = std::min(least, capsule_field(p, Vec3(x, 0.9, 0), Vec3(x, 0.1, z), 0.11));
    return least;
  };
  return Isosurface(field, Vec3(-1.31, -0.11, -0.61), Vec3(1.71, 1.91, 0.61), 0.0501).mesh();
}

double volume(const PolygonMesh& mesh) {
  double six = 0.0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    for (std::size_t k = 1; k + 1 < mesh.face(f).size(); ++k)
      six += mesh.points[mesh.face(f)[0]].dot(
          mesh.points[mesh.face(f)[k]].cross(mesh.points[mesh.face(f)[k + 1]]));
  return six / 6.0;
}

/// A bar from one point to another, with nothing of a limb but its ends.
RigCurve bar(const Vec3& from, const Vec3& to) {
  return {"bar", {from, 0.5 * from + 0.5 * to, to}, {from, from, from}, {}};
}

void add_prism(double half_width, const Vec3& from, const Vec3& to, PolygonMesh& mesh) {
  const double h = half_width;
  PolygonMesh part = prism({{-h, -h}, {h, -h}, {h, h}, {-h, h}}, (to - from).norm(), 1);
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), to - from);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const auto corners = static_cast<std::uint32_t>(mesh.corners.size());
  for (const Vec3& p : part.points) mesh.points.emplace_back(from + turn * p);
  for (const std::uint32_t corner : part.corners) mesh.corners.push_back(first + corner);
  for (std::size_t f = 1; f < part.face_begin.size(); ++f)
    mesh.face_begin.push_back(corners + part.face_begin[f]);
}

/// A column on two legs, with three thin arms that reach as far to one side: on these it would fall over.
TEST(RigStance, IsOneThatDoesNotFallOver) {
  PolygonMesh mesh;
  add_prism(0.15, Vec3(0, 0, 0), Vec3(0, 0, 1), mesh);
  std::vector<RigCurve> curves{bar({0.1, 0, 0.5}, {0.1, 0, 0}), bar({-0.1, 0, 0.5}, {-0.1, 0, 0})};
  for (const double z : {0.4, 0.6, 0.8}) {
    add_prism(0.005, Vec3(0, -0.15, z), Vec3(0, -1, z), mesh);
    curves.push_back(bar({0, -0.15, z}, {0, -1, z}));
  }
  runner::Body body;
  body.volume = volume(mesh);
  ASSERT_GT(body.volume, 0.08);
  body.first_skin.resize(curves.size());
  body.last_skin.resize(curves.size());
  EXPECT_EQ(runner::stand(mesh, curves, body, Vec3::UnitY()).feet.size(), 3U);
  const runner::Stance stance = runner::guess_stance(mesh, curves, body);
  EXPECT_EQ(runner::direction_name(stance.up), "z");
  EXPECT_EQ(stance.feet.size(), 2U);
  // With arms thick enough to rest on, the three of them are the better feet.
  PolygonMesh thick = mesh;
  for (const double z : {0.4, 0.6, 0.8}) add_prism(0.09, Vec3(0, -0.15, z), Vec3(0, -1, z), thick);
  EXPECT_EQ(runner::direction_name(runner::guess_stance(thick, curves, body).up), "y");
}

TEST(RigSections, AreTheSameForAnyNumberOfThreads) {
  const PolygonMesh tube = prism(ellipse_outline(0.3, 0.2, 0.4, 64), 4.0, 80);
  std::vector<RigCurve> curves{straight(0.2, 3.8, 19)}, again = curves;
  const runner::Body one = runner::measure_body(tube, curves, 1), many = runner::measure_body(tube, again, 5);
  for (std::size_t i = 0; i < one.sections[0].size(); ++i) {
    EXPECT_EQ(one.sections[0][i].a, many.sections[0][i].a);
    EXPECT_EQ(one.sections[0][i].b, many.sections[0][i].b);
  }
}

TEST(RigSections, OfAnEllipticTubeAreItsOwn) {
  // A polygon of n corners has sin(2 pi / n) / (2 pi / n) of the ellipse's area: 1 - 4e-4 at 128.
  const PolygonMesh tube = prism(ellipse_outline(0.1, 0.2, 0.0, 128), 3.0, 40);
  std::vector<RigCurve> curves{straight(0.1, 2.9, 15)};
  const runner::Body body = runner::measure_body(tube, curves);
  EXPECT_NEAR(body.volume / volume(tube), 1.0, 1e-12);
  for (const runner::RigSection& section : body.sections[0]) {
    EXPECT_TRUE(section.seen);
    EXPECT_NEAR(section.b, 0.1, 1e-4);  // along y
    EXPECT_NEAR(section.a, 0.2, 1e-4);  // along z
  }
}

TEST(RigSections, OfABoxOfTwelveTrianglesHaveItsAreaAndItsMoments) {
  // p q = pi a b, and p^2 / 12 = a^2 / 4 up to one factor: a : b = p : q.
  const double p = 0.3, q = 0.5;
  const PolygonMesh box = prism({{-p / 2, -q / 2}, {p / 2, -q / 2}, {p / 2, q / 2}, {-p / 2, q / 2}}, 4.0, 1);
  std::vector<RigCurve> curves{straight(0.2, 3.8, 13)};
  const runner::Body body = runner::measure_body(box, curves);
  for (const runner::RigSection& section : body.sections[0]) {
    EXPECT_NEAR(kPi * section.a * section.b, p * q, 1e-9);
    EXPECT_NEAR(section.a / section.b, q / p, 1e-9);
  }
}

TEST(RigSections, DoNotMindWhichWayFacesLookNorAnAxisOffTheMiddle) {
  PolygonMesh tube = prism(ellipse_outline(0.1, 0.2, 0.0, 128), 3.0, 40);
  for (std::size_t f = 0; f < tube.face_count(); ++f)
    std::reverse(tube.corners.begin() + tube.face_begin[f], tube.corners.begin() + tube.face_begin[f + 1]);
  for (Vec3& point : tube.points) point += Vec3(0, 0.02, 0.05);
  std::vector<RigCurve> curves{straight(0.1, 2.9, 15)};
  const runner::Body body = runner::measure_body(tube, curves);
  for (const runner::RigSection& section : body.sections[0]) {
    EXPECT_NEAR(section.b, 0.1, 1e-4);
    EXPECT_NEAR(section.a, 0.2, 1e-4);
  }
}

TEST(RigSections, TurnTheFrameToTheirPrincipalDirections) {
  for (const double degrees : {-40.0, -20.0, 15.0, 44.0}) {
    const PolygonMesh tube = prism(ellipse_outline(0.1, 0.25, degrees * kPi / 180, 128), 3.0, 40);
    std::vector<RigCurve> curves{straight(0.1, 2.9, 15)};
    const runner::Body body = runner::measure_body(tube, curves);
    for (std::size_t i = 0; i < 15; ++i) {
      EXPECT_NEAR(body.sections[0][i].b, 0.1, 1e-4);
      EXPECT_NEAR(body.sections[0][i].a, 0.25, 1e-4);
      const Vec3 m = (curves[0].orientation[i] - curves[0].points[i]).normalized();
      const Vec3 thin(0, std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180));
      EXPECT_NEAR(std::abs(m.dot(thin)), 1.0, 1e-6);
    }
  }
}

TEST(RigSections, WithinABodyGoOverIntoIt) {
  // An arm that leaves the middle of a tube: its first nodes are inside the tube.
  const Field field = [](const Vec3& p) {
    return std::min(capsule_field(p, Vec3(-1.5, 0, 0), Vec3(1.5, 0, 0), 0.3),
                    capsule_field(p, Vec3(0, 0, 0), Vec3(0, 1.5, 0), 0.12));
  };
  const PolygonMesh mesh =
      Isosurface(field, Vec3(-1.91, -0.41, -0.41), Vec3(1.91, 1.81, 0.41), 0.0401).mesh();
  std::vector<RigCurve> curves{straight(-1.5, 1.5, 21)};
  RigCurve arm{"arm", {}, {}};
  for (int i = 0; i <= 10; ++i)
    arm.points.emplace_back(0, 0.15 * i, 0), arm.orientation.emplace_back(0.5, 0.15 * i, 0);
  arm.joint = {0, 10};
  curves.push_back(arm);
  const runner::Body body = runner::measure_body(mesh, curves);
  EXPECT_FALSE(body.sections[1][0].seen);
  EXPECT_TRUE(body.sections[1][5].seen);
  // At the joint as stiff as the tube, at its skin itself.
  EXPECT_GT(body.sections[1][0].a, 0.2);
  EXPECT_LT(body.sections[1][0].a, 0.31);
  for (std::size_t i = 1; i < 11; ++i) EXPECT_LE(body.sections[1][i].a, body.sections[1][i - 1].a + 1e-3);
  EXPECT_FALSE(body.sections[1][2].seen);
  EXPECT_NEAR(body.sections[1][3].a, 0.12, 0.003);
  EXPECT_NEAR(body.sections[1][5].a, 0.12, 0.003);
  // The tube goes on round the arm's root: what is missing there is made up for.
  EXPECT_NEAR(std::sqrt(body.sections[0][10].a * body.sections[0][10].b), 0.3, 0.03);
  EXPECT_NEAR(body.sections[0][3].a, 0.3, 0.005);
}

TEST(RigStance, AnAnimalStandsOnItsFeetWhicheverWayItIsTurned) {
  const Folder folder;
  const PolygonMesh mesh = animal();
  const std::vector<std::pair<std::string, Mat3>> turns{
      {"y", Mat3::Identity()},
      {"z", Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix()},
      {"-y", Eigen::AngleAxisd(kPi, Vec3::UnitX()).toRotationMatrix()},
      {"x", Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()).toRotationMatrix()}};
  for (const auto& [up, turn] : turns) {
    PolygonMesh turned = mesh;
    for (Vec3& p : turned.points) p = turn * p;
    bind::write_mesh(folder / "animal.off", turned);
    const Outcome outcome = folder.run("rig animal.off --out s.json --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json rig = Json::parse(outcome.out);
    const Vec3 expected = turn * Vec3::UnitY();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(rig["up"][k].get<double>(), expected[k], 1e-12) << up;
    EXPECT_EQ(rig["held_as"], "feet") << up;
    EXPECT_EQ(rig["held"].size(), 4U) << up << outcome.out;
  }
}

TEST(Rig, MakesASceneThatWeighsWhatTheMeshHoldsAndRuns) {
  const Folder folder;
  const PolygonMesh mesh = animal();
  bind::write_mesh(folder / "animal.off", mesh);
  std::filesystem::create_directory(folder / "scenes");
  const Outcome outcome =
      folder.run("rig animal.off --out scenes/s.json --size 0.4 --material foam --picture p.png --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(bytes_of(folder / "p.png").substr(1, 3), "PNG");
  const Json rig = Json::parse(outcome.out);
  const scene::SceneFile file = scene::read_scene(folder / "scenes/s.json");
  double mass = 0.0, longest = 0.0;
  for (const Rod& rod : file.scene.rods)
    for (const double m : rod.mass) mass += m;
  for (int k = 0; k < 3; ++k) {
    double low = 1e9, high = -1e9;
    for (const Vec3& p : mesh.points) low = std::min(low, p[k]), high = std::max(high, p[k]);
    longest = std::max(longest, high - low);
  }
  const double expected = 55.0 * volume(mesh) * std::pow(0.4 / longest, 3);
  EXPECT_NEAR(mass / expected, 1.0, 0.01);  // numbers of the file have three digits
  EXPECT_NEAR(rig["mass_kg"].get<double>() / expected, 1.0, 1e-9);
  EXPECT_EQ(file.mesh, folder / "animal.off");

  const Outcome run = folder.run("run scenes/s.json --out out --no-pictures --json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(Json::parse(run.out)["status"], "finished");
  // The same command writes the same bytes.
  const std::string first = bytes_of(folder / "scenes/s.json");
  ASSERT_EQ(folder.run("rig animal.off --out scenes/s.json --size 0.4 --material foam").code, 0);
  EXPECT_EQ(bytes_of(folder / "scenes/s.json"), first);
}

TEST(Rig, IsWhatRunDoesToAMesh) {
  const Folder folder;
  bind::write_mesh(folder / "animal.off", animal());
  const Outcome run = folder.run("run animal.off --out out --no-frames --no-pictures --json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(Json::parse(run.out)["status"], "finished");
  const scene::SceneFile file = scene::read_scene(folder / "out/scene.json");
  EXPECT_EQ(file.scene.anchors.size(), 8U);  // two nodes a foot
}

TEST(Rig, TakesAnAxisDrawnByHand) {
  const Folder folder;
  bind::write_mesh(folder / "beam.off", prism(ellipse_outline(0.1, 0.1, 0, 24), 2.0, 8));
  folder.write("axis.json", R"({"version": 1, "curves": [{"name": "beam",
    "points": [[0.05,0,0],[0.5,0,0],[1,0,0],[1.5,0,0],[1.95,0,0]], "orientation": [0,1,0]}]})");
  const Outcome outcome =
      folder.run("rig beam.off --axis axis.json --hold beam --up y --wind 0 --out s.json --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json rig = Json::parse(outcome.out);
  EXPECT_EQ(rig["held"][0]["curve_pair"], "beam");
  EXPECT_EQ(rig["held"][0]["nodes"], (std::vector<int>{3, 4}));
  EXPECT_EQ(bytes_of(folder / "s.json").find("\"wind\""), std::string::npos);
  // First bending frequency of a clamped beam: 3.516 / (2 pi) sqrt(E I / (rho A)) / L^2, length in metres.
  const double unit = rig["unit_m"], radius = 0.1 * unit, length = 1.9 * unit;
  const double frequency =
      3.516 / (2 * kPi) * std::sqrt(2e6 * radius * radius / (4 * 925)) / (length * length);
  EXPECT_NEAR(rig["period_s"].get<double>() * frequency, 1.0, 0.01);
}

TEST(Rig, RefusesWithAReasonAndWritesNothing) {
  const Folder folder;
  bind::write_mesh(folder / "animal.off", animal());
  bind::write_mesh(folder / "ball.off", Isosurface([](const Vec3& p) { return p.norm() - 1.0; },
                                                   Vec3(-1.2, -1.2, -1.2), Vec3(1.2, 1.2, 1.2), 0.1001)
                                            .mesh());
  folder.write("tube.off", tube_off());
  folder.write("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n2 1 0\n");
  folder.write("axis.json",
               R"({"version": 1, "degree": 1, "points": [[0,0,0],[1,0,0]], "orientation": [0,1,0]})");
  PolygonMesh huge = prism(ellipse_outline(1, 1, 0, 8), 10.0, 4);
  for (Vec3& p : huge.points) p *= 1e100;
  bind::write_mesh(folder / "huge.off", huge);
  folder.write(
      "huge.json",
      R"({"version": 1, "degree": 1, "points": [[0,0,0],[5e100,0,0],[1e101,0,0]], "orientation": [0,1,0]})");
  folder.write("loop.json", R"({"version": 1, "curves": [
    {"name": "a", "points": [[0,0,0],[1,0,0]], "orientation": [0,1,0]},
    {"name": "b", "joint": {"curve_pair": "a", "node": 2}, "points": [[1,0,0],[1,1,0]], "orientation": [1,0,0]}]})");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"ball.off", "ball.off: "},
      {"points.off --axis axis.json", "points.off: no faces"},
      {"huge.off --axis huge.json", "huge.off: "},
      {"tube.off", "tube.off: "},
      {"animal.off --material jelly", "one of: rubber, foam, wood, steel, leaf"},
      {"animal.off --hold nose", "feet, middle, root, lowest, or a curve's name: axis"},
      {"animal.off --size 0", "--size"},
      {"animal.off --size nan", "--size"},
      {"animal.off --wind -1", "--wind"},
      {"animal.off --up w", "--up"},
      {"animal.off --axis loop.json", "loop.json"},
  };
  for (const auto& [arguments, expected] : cases) {
    const Outcome outcome = folder.run("rig " + arguments + " --out s.json");
    EXPECT_EQ(outcome.code, 2) << arguments << outcome.out;
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << arguments << ": " << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "s.json")) << arguments;
  }
}

}  // namespace
}  // namespace tendril::test
