#include <gtest/gtest.h>
#include <tendril/scene/scene_file.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "runner/program.h"

namespace tendril::test {
namespace {

using Json = nlohmann::json;

/// Of all masses over all outputs: how far one is from where it was at first, over the extent of them all.
double largest_displacement(const std::string& trajectory) {
  std::istringstream in(trajectory);
  std::string line;
  std::getline(in, line);
  std::map<std::string, Vec3> first;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double most = 0.0;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    const Vec3 p(std::stod(cells.at(3)), std::stod(cells.at(4)), std::stod(cells.at(5)));
    const auto [at, is_new] = first.try_emplace(cells[1] + ":" + cells[2], p);
    if (is_new) low = low.cwiseMin(p), high = high.cwiseMax(p);
    most = std::max(most, (p - at->second).norm());
  }
  return most / (high - low).maxCoeff();
}

/// What to expect of a mesh: which way it stands, and on how many feet, 0 for any; toes that are curves of
/// their own are held each. It neither keeps still nor falls.
struct Case {
  const char* mesh;
  Vec3 up;
  std::size_t feet;
};

const Vec3 y = Vec3::UnitY(), z = Vec3::UnitZ();

class RigOfAMesh : public testing::TestWithParam<Case> {};

TEST_P(RigOfAMesh, StandsAndMoves) {
  const Folder folder;
  const std::string mesh = std::string(TENDRIL_CGAL_MESHES) + "/" + GetParam().mesh + ".off";
  ASSERT_TRUE(std::filesystem::exists(mesh)) << mesh;
  const Outcome rigged = folder.run("rig '" + mesh + "' --out s.json --json");
  ASSERT_EQ(rigged.code, 0) << rigged.err;
  const Json rig = Json::parse(rigged.out);
  EXPECT_EQ(Vec3(rig["up"].get<std::vector<double>>().data()), GetParam().up);
  if (GetParam().feet > 0) {
    EXPECT_EQ(rig["held_as"], "feet");
    EXPECT_EQ(rig["held"].size(), GetParam().feet);
  }
  const Outcome run = folder.run("run s.json --out out --no-frames --no-pictures --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const double moved = largest_displacement(bytes_of(folder / "out/trajectory.csv"));
  std::printf("%-12s %5.1f s to rig, %4.1f s in all to run, moves by %.3f of its size\n", GetParam().mesh,
              rig["wall_s"].get<double>(), Json::parse(run.out)["wall_s"]["total"].get<double>(), moved);
  EXPECT_GT(moved, 1e-3);
  EXPECT_LT(moved, 0.35);
}

INSTANTIATE_TEST_SUITE_P(Meshes, RigOfAMesh,
                         testing::Values(Case{"diplodocus", y, 4}, Case{"camel", y, 4}, Case{"cow", y, 4},
                                         Case{"bull", y, 4}, Case{"triceratops", y, 4},
                                         Case{"elephant", y, 3}, Case{"bear", y, 0}, Case{"man", z, 2},
                                         Case{"homer", y, 2}, Case{"cactus", y, 0}, Case{"dino", z, 2},
                                         Case{"armadillo", y, 3}, Case{"elk", y, 0}),
                         [](const auto& one) { return std::string(one.param.mesh); });

}  // namespace
}  // namespace tendril::test
