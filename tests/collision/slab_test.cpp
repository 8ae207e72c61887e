#include "collision/axial/slab.h"

#include <gtest/gtest.h>
#include <tendril/curve/axial.h>

#include <cfenv>

#include "collision/axial/interval.h"
#include "collision/axial/patches.h"
#include "collision/axial/slab_table.h"
#include "support/pairs.h"
#include "support/random.h"

namespace tendril::collision {
namespace {

using test::Random;

double spread(Random& random) {
  const double size = std::exp(random.uniform(-3.0, 3.0));
  return random.integer(2) == 0 ? size : -size;
}

/// Signs of a sum, of a product and of the remainder of a quotient, none of them rounded away: sums of two
/// such numbers fit a long double, and a fused operation rounds once.
bool holds_sum(const Interval& i, double a, double b) {
  const long double sum = static_cast<long double>(a) + static_cast<long double>(b);
  return i.low <= sum && sum <= i.high;
}
bool holds_product(const Interval& i, double a, double b) {
  return std::fma(a, b, -i.low) >= 0.0 && std::fma(a, b, -i.high) <= 0.0;
}
bool holds_quotient(const Interval& i, double a, double b) {
  return std::fma(i.low, b, -a) <= 0.0 && std::fma(i.high, b, -a) >= 0.0;
}

TEST(Interval, HoldsExactResultsInAnyRoundingMode) {
  Random random(1);
  const int before = std::fegetround();
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    int held = 0;
    for (int i = 0; i < 20000; ++i) {
      const double a = spread(random), b = spread(random), c = std::abs(spread(random));
      const Interval x{a, a}, y{b, b}, z{c, c};
      std::fesetround(mode);
      const Interval sum = x + y, difference = x - y, product = x * y, quotient = x / z;
      std::fesetround(before);
      held += holds_sum(sum, a, b) && holds_sum(difference, a, -b) && holds_product(product, a, b) &&
              holds_quotient(quotient, a, c);
    }
    EXPECT_EQ(held, 20000);
  }
}

TEST(Interval, HoldsWhatItsPointsGive) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const double a = random.uniform(-2.0, 2.0), b = random.uniform(-2.0, 2.0);
    const Interval x{a, a + random.uniform()}, y{b, b + random.uniform()},
        z{std::abs(b) + 0.1, std::abs(b) + 0.9};
    const double p = random.uniform(x.low, x.high), q = random.uniform(y.low, y.high);
    const double r = random.uniform(z.low, z.high);
    const auto holds = [](const Interval& in, double value) { return in.low <= value && value <= in.high; };
    EXPECT_TRUE(holds(x + y, p + q) && holds(x - y, p - q) && holds(x * y, p * q) && holds(x / z, p / r));
    EXPECT_TRUE(holds(inverse_length(x, y), 1.0 / std::sqrt(1.0 + p * p + q * q)));
  }
}

CurvePair random_pair(int degree, double size, Random& random) {
  const KnotVector knots = KnotVector::uniform(degree, 8);
  std::vector<Vec3> c, d;
  const Vec3 far = random.in_cube(random.integer(2) * 100.0);
  for (int i = 0; i < 8; ++i) {
    c.push_back(far + Vec3(0.2 * i, 0, 0) + random.in_cube(size));
    d.push_back(c.back() + Vec3(0, 0, 0.2) + random.in_cube(size));
  }
  return CurvePair(knots, c, d);
}

/// Extremes of points over many parameters of a slab, relative to the box that is to hold them.
TEST(Slab, BoxesHoldWhatIsInThemAndLittleMore) {
  Random random(3);
  double slack = 0.0;
  long points = 0;
  for (int i = 0; i < 200; ++i) {
    const int degree = 1 + i % 5;
    const CurvePair pair = random_pair(degree, i % 2 == 0 ? 0.03 : 0.3, random);
    SlabTable table({&pair, 1}, 64);
    table.pose({&pair, 1}, 1);
    const double t = random.uniform(), u = random.uniform(-0.3, 0.3), v = random.uniform(-0.3, 0.3);
    const std::uint32_t slab = table.slab_of(0, t);
    const Patch patch{0, slab, slab, Vec3(u, v, 0), Vec3(u, v, 0)};
    const Box box = table.box(slab, slab, range_of(patch));
    Box seen{Vec3::Constant(1e9), Vec3::Constant(-1e9)};
    for (int k = 0; k <= 2000; ++k) {
      const double at = t + (k - 1000) * 1e-5;
      if (at < 0.0 || at > 1.0 || table.slab_of(0, at) != slab) continue;
      const Vec3 p = from_axial(pair, {at, u, v, 0.0});
      EXPECT_TRUE(box.holds(p));
      seen = {seen.low.cwiseMin(p), seen.high.cwiseMax(p)};
      ++points;
    }
    if (i % 2 == 0) slack = std::max(slack, (box.high - box.low).norm() - (seen.high - seen.low).norm());
  }
  EXPECT_GT(points, 200000);
  EXPECT_LT(slack, 0.06);  // a slab is 0.022 long
}

/// Over a whole curve-pair as over its slabs one by one.
TEST(Slab, SpansAndSlabsHoldTheSamePoints) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const CurvePair pair = random_pair(3, 0.1, random);
    SlabTable table({&pair, 1}, 40);
    table.pose({&pair, 1}, 1);
    const Patch all{0, 0, static_cast<std::uint32_t>(table.size() - 1), Vec3::Constant(-0.1),
                    Vec3::Constant(0.1)};
    const Patch most{0, 1, all.last, all.low, all.high};
    const Box whole = table.box(all.first, all.last, range_of(all));
    const Box parts = table.box(most.first, most.last, range_of(most));
    for (int k = 0; k < 200; ++k) {
      const Vec3 q = random.in_cube(0.1);
      const double t = random.uniform();
      const Vec3 p = from_axial(pair, {t, q.x(), q.y(), q.z()});
      EXPECT_TRUE(whole.holds(p));
      EXPECT_TRUE(table.slab_of(0, t) == 0 || parts.holds(p));
    }
  }
}

/// Frames are said to be unknown where an orientation curve crosses the tangent, or the curve stands.
TEST(Slab, HasNoFrameWhereThereIsNone) {
  Random random(5);
  const KnotVector knots = KnotVector::uniform(3, 8);
  std::vector<Vec3> c, along, across;
  for (int i = 0; i < 8; ++i) {
    c.emplace_back(0.1 * i, 0.0, 0.0);
    along.push_back(c.back() + Vec3(0.1, 0, 0));
    across.push_back(c.back() + Vec3(0, 0, i < 4 ? -0.1 : 0.1));
  }
  const auto unframed = [&](const std::vector<Vec3>& u, const std::vector<Vec3>& v) {
    const CurvePair pair(knots, u, v);
    SlabTable table({&pair, 1}, 40);
    table.pose({&pair, 1}, 1);
    const std::size_t spans = table.unframed();
    for (std::uint32_t i = 0; i < table.size(); ++i)
      for (int k = 0; k < 20; ++k) {
        const double t = random.uniform();
        const Vec3 q = random.in_cube(0.2);
        const std::uint32_t slab = table.slab_of(0, t);
        const Patch patch{0, slab, slab, q.cwiseMin(0.0), q.cwiseMax(0.0)};
        EXPECT_TRUE(table.box(slab, slab, range_of(patch)).holds(from_axial(pair, {t, q.x(), q.y(), q.z()})));
      }
    return spans;
  };
  EXPECT_EQ(unframed(c, along), 45U);
  EXPECT_GT(unframed(c, across), 1U);
  EXPECT_LT(unframed(c, across), 20U);
  EXPECT_EQ(unframed(std::vector<Vec3>(8, c[0]), across), 45U);
}

TEST(Patches, JoinTheNearestOfACurvePair) {
  const auto patch = [](std::uint32_t pair, std::uint32_t slab, double u) {
    return Patch{pair, slab, slab, Vec3::Constant(u), Vec3::Constant(u)};
  };
  std::vector<Patch> patches{patch(1, 20, 1), patch(0, 3, -1), patch(0, 4, 2), patch(0, 8, 3),
                             patch(0, 7, 0),  patch(0, 18, 4), patch(1, 30, 5)};
  join_patches(patches, 10);
  ASSERT_EQ(patches.size(), 5U);
  EXPECT_EQ(patches[0].last, 4U);
  EXPECT_EQ(patches[0].low.x(), -1.0);
  EXPECT_EQ(patches[0].high.x(), 2.0);
  join_patches(patches, 4);
  ASSERT_EQ(patches.size(), 4U);
  EXPECT_EQ(patches[0].last, 8U);
  EXPECT_EQ(patches[0].high.x(), 3.0);
  join_patches(patches, 1);
  ASSERT_EQ(patches.size(), 2U);
  EXPECT_EQ(patches[0].last, 18U);
  EXPECT_EQ(patches[1].first, 20U);
  EXPECT_EQ(patches[1].last, 30U);
}

}  // namespace
}  // namespace tendril::collision
