#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/collision/box_tree.h>

#include <limits>
#include <set>

#include "support/random.h"

namespace tendril::collision {
namespace {

using test::Random;

/// Every third one is a point on a coarse grid, so that many boxes only touch.
std::vector<Box> random_boxes(Random& random, std::size_t n) {
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 low = random.in_cube();
    if (i % 3 == 0) low = (4 * low).array().round() / 4;
    boxes.push_back({low, i % 3 == 0 ? low : Vec3(low + Vec3::Constant(0.15) + random.in_cube(0.15))});
  }
  return boxes;
}

std::multiset<std::size_t> found_in(const BoxTree& tree, const Box& query) {
  std::multiset<std::size_t> found;
  tree.descend([&](const Box& box) { return box.meets(query); }, [&](std::size_t i) { found.insert(i); });
  return found;
}

TEST(BoxTree, FindsWhatBruteForceFindsBeforeAndAfterARefit) {
  Random random(1);
  for (const std::size_t n : {1, 2, 3, 7, 64, 500}) {
    std::vector<Box> boxes = random_boxes(random, n);
    BoxTree tree(boxes);
    for (int round = 0; round < 2; ++round) {
      for (const Box& query : random_boxes(random, 60)) {
        std::multiset<std::size_t> expected;
        for (std::size_t i = 0; i < n; ++i)
          if (boxes[i].meets(query)) expected.insert(i);
        EXPECT_EQ(found_in(tree, query), expected) << n;
      }
      boxes = random_boxes(random, n);
      tree.refit(boxes);
    }
  }
}

TEST(BoxTree, PairsAreThoseOfBruteForceEachOnce) {
  Random random(2);
  for (const std::size_t n : {1, 5, 90}) {
    const std::vector<Box> a = random_boxes(random, n), b = random_boxes(random, 70);
    std::multiset<std::pair<std::size_t, std::size_t>> found, expected;
    BoxTree(a).pairs(BoxTree(b), [&](std::size_t i, std::size_t j) { found.emplace(i, j); });
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j)
        if (a[i].meets(b[j])) expected.emplace(i, j);
    EXPECT_EQ(found, expected);
    if (n == 90) EXPECT_FALSE(expected.empty());
  }
}

TEST(BoxTree, NearestFindsTheSmallestDistanceAndLooksAtFew) {
  Random random(3);
  std::vector<Box> boxes;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random.in_cube();
    boxes.push_back({x, x});
  }
  const BoxTree tree(boxes);
  std::size_t looks = 0;
  for (int k = 0; k < 100; ++k) {
    const Vec3 p = random.in_cube(1.5);
    const auto distance = [&](const Box& box) {
      return (p - p.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
    };
    double best = std::numeric_limits<double>::infinity(), least = best;
    tree.nearest(
        distance, [&] { return best; },
        [&](std::size_t i) { best = std::min(best, distance(boxes[i])), ++looks; });
    for (const Box& box : boxes) least = std::min(least, distance(box));
    EXPECT_EQ(best, least);
  }
  EXPECT_LT(looks, 100 * 40u);
}

TEST(BoxTree, HoldsFewBoxesPerQueryOnAGrid) {
  std::vector<Box> boxes;
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    const Vec3 low(i % 16, i / 16 % 16, i / 256);
    boxes.push_back({low, low + Vec3::Constant(0.9)});
  }
  const Box query{Vec3(5.2, 7.2, 3.2), Vec3(5.3, 7.3, 3.3)};
  int opened = 0, found = 0;
  BoxTree(boxes).descend([&](const Box& box) { return ++opened, box.meets(query); },
                         [&](std::size_t) { ++found; });
  EXPECT_EQ(found, 1);
  EXPECT_LE(opened, 25 + 2 * 12);
}

TEST(BoxTree, RefusesWhatIsNoBox) {
  const Vec3 one = Vec3::Ones();
  const std::vector<Box> good{{-one, one}, {one, one}};
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2.0}) {
    std::vector<Box> boxes = good;
    boxes[1].low.y() = bad;
    EXPECT_THROW(BoxTree tree(boxes), InvalidInput);
    BoxTree tree(good);
    EXPECT_THROW(tree.refit(boxes), InvalidInput);
    EXPECT_EQ(tree.box().high, one);
  }
  BoxTree tree(good);
  EXPECT_THROW(tree.refit(std::span(good).first(1)), InvalidInput);
}

TEST(BoxTree, HoldsNothingWithoutItems) {
  const BoxTree none{std::span<const Box>()};
  EXPECT_TRUE(found_in(none, {-Vec3::Ones(), Vec3::Ones()}).empty());
  none.pairs(none, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(BoxTree, BoxesOfHugeNumbersKeepTheirOrder) {
  const double huge = std::numeric_limits<double>::max();
  std::vector<Box> boxes;
  for (int i = 0; i < 9; ++i)
    boxes.push_back({Vec3::Constant(-huge), Vec3::Constant(i % 2 == 0 ? huge : -huge)});
  EXPECT_EQ(found_in(BoxTree(boxes), {Vec3::Ones(), Vec3::Ones()}).size(), 5u);
}

}  // namespace
}  // namespace tendril::collision
