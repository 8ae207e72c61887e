#include <gtest/gtest.h>
#include <tendril/axis/find_axis.h>
#include <tendril/bind/import.h>
#include <tendril/bind/inspect.h>

#include <chrono>
#include <cstdio>

namespace tendril::test {
namespace {

bind::PolygonMesh mesh_of(const std::string& name) {
  return bind::read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + name + ".off");
}

/// Handles of a closed connected surface, from its Euler characteristic.
std::size_t genus(const bind::PolygonMesh& mesh) {
  return static_cast<std::size_t>((2 - bind::inspect(mesh).euler_characteristic) / 2);
}

/// Closed, of one part, with what a look at their pictures counts: curves found at the default options, and
/// the share of the skin with a curve near, in percent; a curve through the palm is far from fingers.
struct Expected {
  const char* name;
  std::size_t loops, least, most;
  double coverage = 99.0;
};
constexpr Expected kMeshes[]{{"diplodocus", 0, 5, 5},
                             {"cactus", 0, 3, 3},
                             {"elephant", 3, 8, 13},
                             {"armadillo", 0, 8, 16},
                             {"camel", 0, 6, 9, 96.0},
                             {"hand", 0, 1, 3, 70.0},
                             {"knot1", 1, 1, 1},
                             {"dino", 0, 6, 14},
                             {"bear", 0, 1, 6},
                             {"homer", 0, 3, 6},
                             {"triceratops", 0, 5, 8},
                             {"cow", 0, 5, 10},
                             {"bull", 0, 5, 9, 98.0},
                             {"double-torus-example", 2, 1, 4},
                             // Flat parts with holes, whose skeletons run to and fro between thin walls.
                             {"couplingdown", 9, 15, 25, 90.0},
                             {"cheese", 133, 200, 320, 85.0}};

TEST(AxisMeshes, LoopsAreTheHandlesAndLimbsAreFound) {
  std::printf("%-22s %8s %7s %7s %6s %7s %8s %8s %10s %6s\n", "mesh", "points", "loops", "curves", "twigs",
              "strays", "outside", "seconds", "coverage", "radii");
  for (const Expected& expected : kMeshes) {
    SCOPED_TRACE(expected.name);
    const bind::PolygonMesh mesh = mesh_of(expected.name);
    const auto start = std::chrono::steady_clock::now();
    const axis::AxisTree tree = axis::find_axis(mesh);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_EQ(tree.status, expected.coverage < 90.0 ? axis::AxisStatus::uncovered : axis::AxisStatus::found);
    EXPECT_GE(100.0 * tree.report.coverage, expected.coverage);
    EXPECT_EQ(genus(mesh), expected.loops);
    EXPECT_EQ(tree.report.loops, expected.loops);
    EXPECT_EQ(tree.report.cuts.size(), expected.loops);
    EXPECT_GE(tree.curves.size(), expected.least);
    EXPECT_LE(tree.curves.size(), expected.most);
    double strays = 0.0;
    std::size_t outside = 0;
    for (const axis::AxisCurve& curve : tree.curves) {
      strays = std::max(strays, curve.strays);
      outside += curve.outside;
      EXPECT_FALSE(curve.folds);
    }
    std::printf("%-22s %8zu %7zu %7zu %6zu %7.2f %8zu %8.2f %8.2f %% %6.1f\n", expected.name,
                mesh.points.size(), tree.report.loops, tree.curves.size(), tree.report.twigs.size(), strays,
                outside, seconds, 100.0 * tree.report.coverage, tree.report.farthest_radii);
  }
}

}  // namespace
}  // namespace tendril::test
