#include <gtest/gtest.h>
#include <tendril/bind/export.h>
#include <tendril/scene/scene_file.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "axis/shapes.h"
#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;
using bind::PolygonMesh;

/// Where the last node stands in the equilibrium of a scene, and in the scene.
double moved_in_equilibrium(const Folder& folder, const std::string& scene) {
  const Outcome outcome = folder.run("statics " + scene + " --out still --no-pictures");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string rows = bytes_of(folder / "still/trajectory.csv");
  std::istringstream row(rows.substr(rows.rfind('\n', rows.size() - 2) + 1));
  std::vector<double> numbers;
  for (std::string cell; std::getline(row, cell, ',');) numbers.push_back(std::stod(cell));
  const Rod rod = scene::read_scene(folder / scene).scene.rods.back();
  return (Vec3(numbers.at(3), numbers.at(4), numbers.at(5)) - rod.p.back()).norm();
}

/// A ball on a stem is a column with its weight on top, which tilts: as large as that can be, it stands.
TEST(Rig, StandsOnOneLeg) {
  const Folder folder;
  const Field field = [](const Vec3& p) {
    return std::min(capsule_field(p, Vec3(0, 0, 0), Vec3(0, 0, 1.2), 0.09),
                    (p - Vec3(0, 0, 1.4)).norm() - 0.4);
  };
  bind::write_mesh(folder / "lolli.off",
                   Isosurface(field, Vec3(-0.51, -0.51, -0.21), Vec3(0.5, 0.5, 2.0), 0.0301).mesh());
  const Outcome outcome = folder.run("rig lolli.off --wind 0 --up z --out s.json --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json rig = Json::parse(outcome.out);
  EXPECT_EQ(rig["held_as"], "feet");
  EXPECT_NEAR(rig["legs_carry"].get<double>(), 3.0, 0.3);  // the size has two digits
  EXPECT_LT(moved_in_equilibrium(folder, "s.json"), 0.05);
  // Three times as large it only just stands, ten times as large it does not.
  const double size = rig["size_m"];
  const std::string again = "rig lolli.off --wind 0 --up z --out t.json --material " +
                            rig["material"].get<std::string>() + " --size ";
  ASSERT_EQ(folder.run(again + std::to_string(10.0 * size)).code, 0);
  EXPECT_GT(moved_in_equilibrium(folder, "t.json"), 0.3);
}

/// Sections of the largest part are its own, whatever else the mesh holds.
TEST(Rig, MeasuresTheLargestPartAlone) {
  const Folder folder;
  PolygonMesh mesh = capsule(), other = capsule();
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (const Vec3& p : other.points) mesh.points.push_back(0.99 * p + Vec3(0, 5, 0));
  for (const std::uint32_t corner : other.corners) mesh.corners.push_back(first + corner);
  for (std::size_t f = 1; f <= other.face_count(); ++f)
    mesh.face_begin.push_back(mesh.face_begin[other.face_count()] + other.face_begin[f]);
  bind::write_mesh(folder / "two.off", mesh);
  const Outcome outcome = folder.run("rig two.off --largest-part --out s.json --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  for (const double a : json["curves"][0]["a"]) EXPECT_NEAR(a, 0.2, 0.01);
}

/// A ring's axis is cut open, which is said; its sections are seen all the way round.
TEST(Rig, SaysThatARingIsCutOpen) {
  const Folder folder;
  bind::write_mesh(folder / "ring.off", torus());
  const Outcome outcome = folder.run("rig ring.off --out s.json --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json rig = Json::parse(outcome.out);
  EXPECT_NE(rig["doubt"].get<std::string>().find("cut open"), std::string::npos) << rig["doubt"];
  const auto seen = rig["curves"][0]["seen"].get<std::vector<bool>>();
  EXPECT_GE(std::count(seen.begin(), seen.end(), true) + 2, static_cast<long>(seen.size()));
  for (const double a : rig["curves"][0]["a"]) EXPECT_NEAR(a, 0.25, 0.03);
}

}  // namespace
}  // namespace tendril::test
