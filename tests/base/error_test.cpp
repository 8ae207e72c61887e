#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/base/types.h>

#include <limits>

namespace tendril {
namespace {

TEST(InvalidInput, NamesPlaceReasonAndExpectation) {
  const InvalidInput error("mesh.off:12", "vertex index 9", "an index in [0, 8)");
  EXPECT_STREQ(error.what(), "mesh.off:12: vertex index 9; expected an index in [0, 8)");
  EXPECT_EQ(error.place(), "mesh.off:12");
}

TEST(AllFinite, FindsOneBadCoordinate) {
  std::vector<Vec3> points(5, Vec3(1, 2, 3));
  EXPECT_TRUE(all_finite(points));
  points[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(all_finite(points));
  points[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(all_finite(points));
}

}  // namespace
}  // namespace tendril
