#include <gtest/gtest.h>
#include <tendril/collision/box_queries.h>

#include <algorithm>

#include "support/random.h"

namespace tendril::collision {
namespace {

using test::Random;

Box some_box(Random& random) {
  const Vec3 a = random.in_cube();
  const Vec3 b = random.integer(4) == 0 ? a : random.in_cube();
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

/// The parameters of the segment that are in the box's three slabs: the most that is missing of an overlap.
double apart(const Box& box, const Vec3& a, const Vec3& b) {
  double from = 0.0, to = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double step = b[i] - a[i], p = (box.low[i] - a[i]) / step, q = (box.high[i] - a[i]) / step;
    from = std::max(from, std::min(p, q));
    to = std::min(to, std::max(p, q));
  }
  return from - to;
}

TEST(BoxQueries, TellWhichSegmentsMeetABox) {
  Random random(1);
  int meeting = 0;
  for (int i = 0; i < 100000; ++i) {
    const Box box = some_box(random);
    const Vec3 a = random.in_cube(1.5);
    const Vec3 b = i % 3 == 0 ? Vec3(0.5 * (box.low + box.high) + random.in_cube(0.5)) : random.in_cube(1.5);
    const double gap = apart(box, a, b);
    const bool meets = segment_meets(box, a, b);
    if (gap < -1e-9) EXPECT_TRUE(meets);
    if (gap > 1e-9) EXPECT_FALSE(meets);
    meeting += meets;
  }
  EXPECT_GT(meeting, 10000);
}

TEST(BoxQueries, TouchingSegmentsMeet) {
  const Box box{Vec3::Zero(), Vec3::Ones()};
  EXPECT_TRUE(segment_meets(box, {1, -1, 0.5}, {1, 2, 0.5}));
  EXPECT_TRUE(segment_meets(box, {0.5, 1.5, 1}, {1.5, 0.5, 1}));
  EXPECT_TRUE(segment_meets(box, {1, 1, 1}, {2, 2, 2}));
  EXPECT_TRUE(segment_meets(box, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}));
  EXPECT_FALSE(segment_meets(box, {1.5, 0.5, 0.5}, {1.5, 0.5, 0.5}));
  EXPECT_FALSE(segment_meets(box, {0.6, 1.5, 1}, {1.6, 0.5, 1}));
}

TEST(BoxQueries, TellTheDistanceOfAPoint) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const Box box = some_box(random);
    const Vec3 p = random.in_cube(2.0), nearest = p.cwiseMax(box.low).cwiseMin(box.high);
    EXPECT_DOUBLE_EQ(square_distance(box, p), (p - nearest).squaredNorm());
  }
}

}  // namespace
}  // namespace tendril::collision
