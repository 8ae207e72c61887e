#include <gtest/gtest.h>
#include <tendril/exact/surface.h>

#include <bit>
#include <cfenv>
#include <cmath>
#include <limits>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "collision/minkowski.h"
#include "collision/triangle_pairs.h"

/// Numbers and hosts that wish no good: no crash, the right status, the right answer where there is one.
namespace tendril::exact {
namespace {

using test::Random;

#ifdef TENDRIL_MANY_QUERIES
constexpr int kQueries = TENDRIL_MANY_QUERIES;
#else
constexpr int kQueries = 20000;
#endif

/// Often the same few, so that points coincide.
double hostile(Random& random) {
  using limits = std::numeric_limits<double>;
  constexpr double kSpecial[] = {0.0,
                                 -0.0,
                                 1.0,
                                 -1.0,
                                 1.5,
                                 1e300,
                                 -1e300,
                                 1e-300,
                                 limits::max(),
                                 limits::lowest(),
                                 limits::min(),
                                 limits::denorm_min(),
                                 -limits::denorm_min(),
                                 1 + 0x1p-52};
  constexpr double kBad[] = {limits::quiet_NaN(), limits::infinity(), -limits::infinity()};
  const int kind = random.integer(400);
  if (kind < 3) return kBad[kind];
  if (kind < 300) return kSpecial[kind % 14];
  if (kind < 350) return std::bit_cast<double>(random.bits());
  return random.uniform(-2, 2);
}

Vec3 hostile_point(Random& random) {
  Vec3 x;
  for (double& c : x) c = hostile(random);
  return x;
}

Shape hostile_shape(Random& random) {
  Shape s{static_cast<Kind>(random.integer(5)), {}};
  for (Vec3& x : s.points) x = hostile_point(random);
  if (s.kind != Kind::triangle) s.points[2] = s.points[0];
  const bool two = s.kind == Kind::segment || s.kind == Kind::capsule;
  if (!two && s.kind != Kind::triangle) s.points[1] = s.points[0];
  if (s.kind == Kind::ball || s.kind == Kind::capsule) s.radius = std::abs(hostile(random));
  if (random.integer(50) == 0) s.radius = -1.0;
  return s;
}

bool usable(const Shape& s) {
  return all_finite(s.points) && std::isfinite(s.radius) && s.radius >= 0.0;
}

TEST(Hostile, EveryQueryHasItsStatus) {
  Random random(1);
  int decided = 0;
  for (int i = 0; i < kQueries; ++i) {
    const Shape a = hostile_shape(random), b = hostile_shape(random);
    const Answer ab = relation(a, b);
    if (!usable(a) || !usable(b)) {
      EXPECT_EQ(ab, undecidable(Reason::not_finite));
      EXPECT_EQ(distance(a, b).answer, ab);
      continue;
    }
    ++decided;
    EXPECT_NE(ab.relation, Relation::undecidable);
    EXPECT_EQ(relation(b, a), ab);
    if (i % 4 != 0) continue;
    const Distance d = distance(a, b);
    EXPECT_EQ(d.answer, ab);
    EXPECT_LE(d.lower, d.upper);
    EXPECT_EQ(d.upper > 0.0, ab.relation == Relation::free) << i;
  }
  EXPECT_GT(decided, kQueries / 2);
}

TEST(Hostile, FiniteTrianglesLieAsTheyTrulyDo) {
  Random random(2);
  for (int i = 0; i < kQueries / 40; ++i) {
    Triangle a{hostile_point(random), hostile_point(random), hostile_point(random)}, b = a;
    for (Vec3& x : b)
      if (random.integer(3) > 0) x = hostile_point(random);
    if (!all_finite(a) || !all_finite(b)) continue;
    EXPECT_EQ(relation(a, b), Answer{test::minkowski_relation(a, b)});
  }
}

TEST(Hostile, SurfacesOfExtremeNumbersAnswer) {
  Random random(3);
  for (int i = 0; i < kQueries / 200; ++i) {
    std::vector<Vec3> points;
    while (points.size() < 8)
      if (const Vec3 x = hostile_point(random); is_finite(x)) points.push_back(x);
    std::vector<std::uint32_t> corners;
    for (int k = 0; k < 36; ++k) corners.push_back(static_cast<std::uint32_t>(random.integer(8)));
    const Surface s(points, corners);
    const Shape shape = hostile_shape(random);
    EXPECT_EQ(s.relation(shape).relation == Relation::undecidable, !usable(shape));
    EXPECT_EQ(s.inside(shape.points[0]).answer.reason == Reason::not_finite, !is_finite(shape.points[0]));
    if (!usable(shape)) continue;
    EXPECT_EQ(s.nearest(shape).distance.upper > 0.0, s.relation(shape).relation == Relation::free);
    EXPECT_EQ(s.meetings(shape).empty(), s.relation(shape).relation == Relation::free);
  }
}

/// Made before the host turns strange. The balls' radii make some nearly touch.
std::vector<test::TrianglePair> pairs_of_all_families() {
  std::vector<test::TrianglePair> out;
  for (const test::PairFamily& family : test::pair_families()) {
    Random random(4);
    for (int i = 0; i < 200; ++i) out.push_back(family.next(random));
  }
  return out;
}

struct Answers {
  std::vector<Answer> relations;
  std::vector<Distance> distances;
};

Answers answers(const std::vector<test::TrianglePair>& pairs) {
  Answers out;
  for (const test::TrianglePair& p : pairs) {
    out.relations.push_back(relation(p.a, p.b));
    out.relations.push_back(relation(segment({p.a[0], p.a[1]}), triangle(p.b)));
    out.relations.push_back(relation(ball(p.a[0], std::abs(p.a[1].x())), capsule({p.b[0], p.b[1]}, 0.0)));
    out.distances.push_back(distance(triangle(p.a), triangle(p.b)));
  }
  return out;
}

/// Bounds may differ, but both hold the true distance.
void expect_same(const Answers& a, const Answers& b) {
  EXPECT_TRUE(a.relations == b.relations);
  for (std::size_t i = 0; i < a.distances.size(); ++i) {
    EXPECT_LE(a.distances[i].lower, b.distances[i].upper);
    EXPECT_LE(b.distances[i].lower, a.distances[i].upper);
  }
}

TEST(Hostile, EveryRoundingModeGivesTheSameAnswersAndStaysAsItWas) {
  const auto pairs = pairs_of_all_families();
  const int before = std::fegetround();
  const Answers nearest = answers(pairs);
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const Answers here = answers(pairs);
    const int after = std::fegetround();
    std::fesetround(before);
    EXPECT_EQ(after, mode);
    expect_same(here, nearest);
  }
}

#ifdef __SSE2__
/// Denormal numbers taken for zero by every operation of the host's: they are none in the answers.
TEST(Hostile, HostsThatFlushDenormalsGetTheSameRelations) {
  constexpr unsigned kFlush = 0x8040;
  const auto pairs = pairs_of_all_families();
  const Answers plain = answers(pairs);
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlush);
  const Answers flushed = answers(pairs);
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(after & kFlush, kFlush);
  for (std::size_t i = 0; i < plain.relations.size(); ++i)
    EXPECT_EQ(flushed.relations[i], plain.relations[i]) << i;
}
#endif

}  // namespace
}  // namespace tendril::exact
