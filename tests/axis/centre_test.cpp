#include "axis/centre.h"

#include <gtest/gtest.h>

#include "axis/shapes.h"

// Lines within a capsule about the x axis, of radius 0.2.
namespace tendril::test {
namespace {

/// From x = -1 to 1, at y for the points from `first` on, `count` of them, and on the axis for the others.
axis::Line line_with(double y, std::size_t first, std::size_t count) {
  axis::Line line;
  for (std::size_t k = 0; k <= 80; ++k)
    line.emplace_back(-1.0 + 0.025 * static_cast<double>(k), k >= first && k < first + count ? y : 0.0, 0.0);
  return line;
}

double farthest_off(const axis::Line& line) {
  double off = 0.0;
  for (const Vec3& p : line) off = std::max(off, p.tail<2>().norm());
  return off;
}

class Centred : public testing::Test {
 protected:
  axis::Line of(const axis::Line& line) const { return axis::centred(line, surface_, {.first = true}); }
  const bind::PolygonMesh mesh_ = capsule();
  const axis::Surface surface_{mesh_};
};

TEST_F(Centred, DrawsStrayPointsToTheMiddle) {
  // A move is the mean of five: beside the last stray point, two of them move, by 0.15 each.
  EXPECT_LT(farthest_off(of(line_with(0.15, 38, 9))), 0.4 * 0.15 + 0.01);
}

TEST_F(Centred, DrawsPointsOutsideIn) {
  for (const Vec3& p : of(line_with(0.25, 38, 9))) EXPECT_TRUE(surface_.holds(p)) << p.transpose();
}

TEST_F(Centred, LeavesPointsInTheMiddleAndTheFirst) {
  EXPECT_LT(farthest_off(of(line_with(0.0, 0, 0))), 1e-4);
  EXPECT_EQ(of(line_with(0.15, 0, 3)).front(), Vec3(-1.0, 0.15, 0.0));
}

TEST_F(Centred, DrawsALineThatIsALittleToOneSideToTheMiddle) {
  const axis::Line aside = line_with(0.06, 0, 81);
  EXPECT_LT(farthest_off(axis::centred(aside, surface_, {})), 0.01 * 0.06);
  const axis::Line held = of(aside);
  EXPECT_EQ(held.front(), aside.front());
  EXPECT_LT(farthest_off({held.begin() + 8, held.end()}), 0.1 * 0.06);
}

TEST_F(Centred, LeavesPointsInOnePlace) {
  const axis::Line line(10, Vec3(0.1, 0.02, 0.0));
  for (const Vec3& p : axis::centred(line, surface_, {})) EXPECT_EQ(p, line[0]);
}

TEST_F(Centred, LeavesALineThatRunsBeneathAFlank) {
  // Nothing nearby says that the limb is wider than three times its clearance of 0.05.
  EXPECT_NEAR(of(line_with(0.15, 0, 81))[40].y(), 0.15, 1e-12);
}

}  // namespace
}  // namespace tendril::test
