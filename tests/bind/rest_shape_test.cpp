#include <gtest/gtest.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/import.h>

#include "support/pairs.h"

namespace tendril::bind {
namespace {

class EveryMesh : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, EveryMesh,
                         testing::Values("diplodocus.off", "armadillo.off", "elephant.off", "cactus.off",
                                         "camel.off", "dino.off", "bear.off", "knot1.off", "hand.off",
                                         "triceratops.off"));

TEST_P(EveryMesh, ComesBackUnmoved) {
  const PolygonMesh mesh = read_mesh(std::string(TENDRIL_CGAL_MESHES) + "/" + GetParam());
  const double size = bounding_diagonal(mesh.points);
  for (const double bend : {0.0, 0.15}) {
    const std::vector<Vec3> axis = test::axis_through(mesh.points, bend);
    const Binding binding(test::pair_through(axis, test::side_of(axis), 0.1 * size), mesh.points);
    std::printf("%-18s bend %.2f: rest error %.1e of the size, proven gap %.1e\n", GetParam(), bend,
                binding.report().rest_error / size, binding.report().largest_gap / size);
    EXPECT_LT(binding.report().rest_error, 1e-13 * size);
    EXPECT_LT(binding.report().largest_gap, 1e-12 * size);
    EXPECT_TRUE(binding.report().degenerate.empty());
  }
}

}  // namespace
}  // namespace tendril::bind
