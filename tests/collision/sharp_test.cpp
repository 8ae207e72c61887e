#include <gtest/gtest.h>

#include <cfenv>

#include "collision/continuous/relative_paths.h"
#include "collision/continuous/sharp_determinant.h"
#include "collision/made_queries.h"
#include "support/meeting_truth.h"

// Sums of two doubles, and the determinant made of them, against rationals in every rounding mode.
namespace tendril::collision {
namespace {

using test::Random;
using test::Ratio;

constexpr int kModes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

/// Runs act() in the mode alone: rationals are left out of it.
template <class Act>
auto in_mode(int mode, const Act& act) {
  const int before = std::fegetround();
  std::fesetround(mode);
  const auto result = act();
  std::fesetround(before);
  return result;
}

Ratio exact(const Twofold& x) {
  return Ratio(x.high) + Ratio(x.low);
}

/// Of few bits or many, near powers of two, and of sizes near or far from each other.
double number(Random& random) {
  double x = std::ldexp(random.uniform(0.5, 1.0), random.integer(4) == 0 ? random.integer(120) - 60 : 0);
  const int kind = random.integer(4);
  if (kind == 0) x = std::ldexp(1.0 + random.integer(3) * 0x1p-52, random.integer(60) - 30);
  if (kind == 1) x = std::ldexp(1.0 - random.integer(3) * 0x1p-53, random.integer(60) - 30);
  return random.integer(2) == 0 ? x : -x;
}

Twofold twofold(Random& random) {
  const double high = number(random);
  return Twofold::sum(high, high * random.uniform(-0x1p-53, 0x1p-53));
}

TEST(Twofold, OperationsAreAsNearAsSaidInAnyRoundingMode) {
  Random random(1);
  for (int i = 0; i < 40000; ++i) {
    const int mode = kModes[i % 4];
    const Twofold a = twofold(random);
    const Twofold near{-a.high * (1.0 + random.integer(3) * 0x1p-52), a.low * random.uniform(-1.0, 1.0)};
    const Twofold b = random.integer(3) == 0 ? near : twofold(random);
    const Twofold sum = in_mode(mode, [&] { return a + b; });
    const Twofold product = in_mode(mode, [&] { return a * b; });
    const Ratio x = exact(a), y = exact(b), unit(Twofold::error);
    ASSERT_LE(abs(exact(sum) - (x + y)), unit * (abs(x) + abs(y))) << mode;
    ASSERT_LE(abs(exact(product) - x * y), unit * abs(x * y)) << mode;
  }
}

/// By Bernstein's form in rationals.
template <int Degree>
Ratio true_determinant(const Paths<Degree>& paths, double time) {
  const Ratio t(time), s = 1 - t;
  std::array<std::array<Ratio, 3>, 3> d;
  for (int which = 0; which < 3; ++which)
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i <= Degree; ++i) {
        Ratio weight = Degree == 3 && (i == 1 || i == 2) ? 3 : 1;
        for (int j = 0; j < Degree; ++j) weight *= j < i ? t : s;
        d[which][k] += weight * (Ratio(paths[which + 1][i][k]) - Ratio(paths[0][i][k]));
      }
  const auto minor = [&](int x, int y) { return Ratio(d[1][x] * d[2][y] - d[1][y] * d[2][x]); };
  return d[0][0] * minor(1, 2) + d[0][1] * minor(2, 0) + d[0][2] * minor(0, 1);
}

template <int Degree>
void check_determinants() {
  test::QueryMaker<Degree> maker(3);
  Random random(2);
  Ratio worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto query = maker.make(i % 3 == 0 ? Features::vertex_face : Features::edge_edge, i);
    const RelativePaths<Degree> relative(query.paths);
    const double time = random.uniform();
    const double value =
        in_mode(kModes[i % 4], [&] { return SharpDeterminant<Degree>(query.paths, relative.scale())(time); });
    const Ratio truth = true_determinant<Degree>(query.paths, time), off = abs(Ratio(value) - truth);
    const Ratio allowed(SharpDeterminant<Degree>::error() * relative.permanent());
    ASSERT_LE(off, abs(truth) * Ratio(0x1p-52) + allowed) << query.kind;
    if (allowed > 0 && off > abs(truth) * Ratio(0x1p-52)) worst = std::max(worst, Ratio(off / allowed));
  }
  EXPECT_LT(worst, Ratio(1, 100));  // there is room
}

TEST(SharpDeterminant, IsAsNearAsSaidInAnyRoundingMode) {
  check_determinants<1>();
  check_determinants<3>();
}

/// Those that graze each other too, where the determinant alone crosses zero too flatly for doubles.
template <int Degree>
void check_brackets() {
  test::QueryMaker<Degree> maker(5);
  int hits = 0, grazing = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto query = maker.make(i % 2 == 0 ? Features::vertex_face : Features::edge_edge, i);
    const FirstMeeting found = first_meeting<Degree>(query.features, query.paths);
    if (found.meeting != Meeting::hit) continue;
    ++hits;
    grazing += query.kind == "near miss";
    EXPECT_LE(found.to - found.from, 0x1p-40) << query.kind;
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(grazing, 100);
}

TEST(FirstMeeting, IsNarrowedInDoublesWhereverDoublesFindIt) {
  check_brackets<1>();
  check_brackets<3>();
}

}  // namespace
}  // namespace tendril::collision
