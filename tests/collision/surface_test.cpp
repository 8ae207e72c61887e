#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/exact/surface.h>

#include <cmath>

#include "collision/made_meshes.h"
#include "support/numbers.h"
#include "support/random.h"

namespace tendril::exact {
namespace {

using test::Random;

using tendril::test::kInfinity;
using tendril::test::kNaN;

struct Mesh : test::MadeMesh {
  Surface surface() const { return Surface(points, corners); }
};
Mesh cube(int n) {
  return {test::cube(n)};
}
Mesh wavy_ball(int n) {
  return {test::wavy_ball(n)};
}

Answer where(const Surface& s, const Vec3& x) {
  return s.inside(x).answer;
}

/// On multiples of 1/2, where rays run through edges, corners and along sides.
TEST(Surface, ACubeHoldsThePointsThatItHolds) {
  for (const int n : {1, 2, 4}) {
    const Surface s = cube(n).surface();
    ASSERT_TRUE(s.closed());
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        for (int k = -3; k <= 3; ++k) {
          const Vec3 x(0.5 * i, 0.5 * j, 0.5 * k);
          const double most = x.cwiseAbs().maxCoeff();
          const Answer truth = most < 1   ? collision::kHit
                               : most > 1 ? collision::kFree
                                          : collision::kTouching;
          EXPECT_EQ(where(s, x), truth) << n << ": " << x.transpose();
          if (most != 1) EXPECT_EQ(s.inside(x).winding, most < 1 ? 1.0 : 0.0);
        }
  }
}

TEST(Surface, PointsAUlpOffAFaceAreOnTheirSide) {
  const Surface s = cube(2).surface();
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      Vec3 x(0.25, 0.125, -0.375);
      x[k] = sign;
      EXPECT_EQ(where(s, x), collision::kTouching);
      x[k] = sign * std::nextafter(1.0, 0.0);
      EXPECT_EQ(where(s, x), collision::kHit);
      x[k] = sign * std::nextafter(1.0, 2.0);
      EXPECT_EQ(where(s, x), collision::kFree);
    }
}

/// The parity of one ray against the winding number of all solid angles.
TEST(Surface, InsideIsWhereTheSolidAnglesSumUp) {
  const Mesh mesh = wavy_ball(12);
  const Surface s = mesh.surface();
  ASSERT_TRUE(s.closed());
  // A triangle less: open, and its winding number is that of the ball less a small solid angle.
  const Surface open(mesh.points, std::span(mesh.corners).subspan(3));
  ASSERT_FALSE(open.closed());
  Random random(1);
  int within = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 x = random.in_cube(1.2);
    const Inside in = s.inside(x), nearly = open.inside(x);
    EXPECT_EQ(nearly.answer, undecidable(Reason::open));
    if (std::abs(nearly.winding - 0.5) < 0.4) continue;
    EXPECT_EQ(in.answer, nearly.winding > 0.5 ? collision::kHit : collision::kFree) << nearly.winding;
    EXPECT_EQ(in.winding, std::round(nearly.winding));
    within += in.answer == collision::kHit;
  }
  EXPECT_GT(within, 500);
}

/// Two cubes that overlap are one solid, a cube turned inward in another is a cavity, and one turned
/// outward is not; of a cube with a triangle turned, parity tells.
TEST(Surface, IsGoneRoundHoweverOften) {
  const auto both = [](double size, const Vec3& at, bool turned) {
    Mesh all = cube(1), other = cube(1);
    const auto first = static_cast<std::uint32_t>(all.points.size());
    for (const Vec3& p : other.points) all.points.push_back(at + size * p);
    for (std::size_t i = 0; i < other.corners.size(); i += 3)
      for (const std::size_t k : {0, 1, 2})
        all.corners.push_back(first + other.corners[i + (turned ? 2 - k : k)]);
    return all.surface();
  };
  const Surface overlap = both(1.0, {1, 0.25, 0.125}, false), cavity = both(0.5, Vec3::Zero(), true),
                filled = both(0.5, Vec3::Zero(), false);
  EXPECT_EQ(overlap.closure(), Closure::oriented);
  EXPECT_EQ(where(overlap, {0.5, 0.5, 0.5}), collision::kHit);
  EXPECT_EQ(overlap.inside({0.5, 0.5, 0.5}).winding, 2.0);
  EXPECT_EQ(where(overlap, {1.5, 0.5, 0.5}), collision::kHit);
  EXPECT_EQ(where(overlap, {2.5, 0.5, 0.5}), collision::kFree);
  EXPECT_EQ(where(cavity, {0.1, 0.2, 0.3}), collision::kFree);
  EXPECT_EQ(where(cavity, {0.1, 0.2, 0.7}), collision::kHit);
  EXPECT_EQ(where(filled, {0.1, 0.2, 0.3}), collision::kHit);
  EXPECT_EQ(overlap.solid_relation({0.5, 0.5, 0.5}, 0.1), collision::kHit);
  Mesh turned = cube(1);
  std::swap(turned.corners[0], turned.corners[1]);
  const Surface even = turned.surface();
  EXPECT_EQ(even.closure(), Closure::even);
  EXPECT_EQ(where(even, {0.1, 0.2, 0.3}), collision::kHit);
  EXPECT_EQ(where(even, {0.1, 0.2, 1.3}), collision::kFree);
}

TEST(Surface, OfAnOpenMeshThePointsOnItAreKnown) {
  const Mesh mesh = cube(1);
  const Surface open(mesh.points, std::span(mesh.corners).subspan(6));
  EXPECT_EQ(where(open, {0, 1, 0.5}), collision::kTouching);
  EXPECT_EQ(where(open, {0, 0, 0}), undecidable(Reason::open));
  EXPECT_NEAR(open.inside({0, 0, 0}).winding, 5.0 / 6, 1e-14);
}

std::vector<Meeting> brute(const Surface& a, const Surface& b) {
  std::vector<Meeting> out;
  for (std::uint32_t i = 0; i < a.size(); ++i)
    for (std::uint32_t j = 0; j < b.size(); ++j) {
      const Answer r = relation(a.triangle(i), b.triangle(j));
      if (r.relation != Relation::free) out.push_back({i, j, r.relation});
    }
  return out;
}

TEST(Surface, PairsOfTwoMeshesAreThoseOfBruteForce) {
  Mesh a = cube(3), b = wavy_ball(6);
  Surface s = a.surface();
  const Surface t = b.surface();
  for (const double shift : {0.0, 0.3, 1.0, 5.0}) {
    std::vector<Vec3> moved = a.points;
    for (Vec3& x : moved) x.x() += shift;
    s.refit(moved);
    EXPECT_EQ(s.meetings(t), brute(s, t));
    EXPECT_EQ(s.meetings(t).empty(), shift == 5.0);
  }
  s.refit(a.points);
  EXPECT_EQ(s.meetings(s), brute(s, s));
}

TEST(Surface, ShapesMeetTheTrianglesThatTheyMeet) {
  const Surface s = wavy_ball(8).surface();
  Random random(2);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = random.in_cube(1.3), y = random.in_cube(1.3), z = random.in_cube(1.3);
    const double r = random.uniform(0, 0.3);
    for (const Shape& shape :
         {point(x), segment({x, y}), triangle({x, y, z}), ball(x, r), capsule({x, y}, r)}) {
      std::vector<Meeting> expected;
      Relation most = Relation::free;
      for (std::uint32_t j = 0; j < s.size(); ++j) {
        const Relation one = relation(shape, triangle(s.triangle(j))).relation;
        most = std::max(most, one);
        if (one != Relation::free) expected.push_back({j, 0, one});
      }
      EXPECT_EQ(s.meetings(shape), expected);
      EXPECT_EQ(s.relation(shape), Answer{most});
      met += most != Relation::free;
    }
  }
  EXPECT_GT(met, 200);
}

TEST(Surface, TheNearestTriangleIsThatOfBruteForce) {
  const Surface s = cube(5).surface();
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x =
        i % 2 == 0 ? Vec3(random.in_cube(2)) : Vec3(2 * (2 * random.in_cube(2)).array().round() / 5);
    for (const Shape& shape : {point(x), ball(x, 0.1), segment({x, x + random.in_cube(0.3)})}) {
      Distance best = distance(shape, triangle(s.triangle(0)));
      std::uint32_t which = 0;
      for (std::uint32_t j = 1; j < s.size(); ++j) {
        const Distance d = distance(shape, triangle(s.triangle(j)));
        if (d.upper < best.upper) best = d, which = j;
      }
      const Nearest found = s.nearest(shape);
      EXPECT_EQ(found.triangle, which);
      EXPECT_EQ(found.distance.upper, best.upper);
      EXPECT_EQ(found.distance.lower, best.lower);
    }
  }
}

TEST(Surface, ABallIsWithASolidWhereItMeetsItsInside) {
  const Surface s = cube(2).surface();
  EXPECT_EQ(s.relation(ball({0, 0, 0}, 0.5)), collision::kFree);
  EXPECT_EQ(s.solid_relation({0, 0, 0}, 0.5), collision::kHit);
  EXPECT_EQ(s.solid_relation({0, 0, 0}, 1.0), collision::kHit);  // touches the surface from within
  EXPECT_EQ(s.solid_relation({0, 0, 1.5}, 0.5), collision::kTouching);
  EXPECT_EQ(s.solid_relation({0, 0, 1.5}, std::nextafter(0.5, 0.0)), collision::kFree);
  EXPECT_EQ(s.solid_relation({0, 0, 1.5}, std::nextafter(0.5, 1.0)), collision::kHit);
  EXPECT_EQ(s.solid_relation({0, 0, 5}, 100), collision::kHit);
  EXPECT_EQ(s.solid_relation({1, 1, 1}, 0), collision::kTouching);
  const Mesh mesh = cube(2);
  const Surface open(mesh.points, std::span(mesh.corners).subspan(3));
  EXPECT_EQ(open.solid_relation({0, 0, 0}, 0.5), undecidable(Reason::open));
  EXPECT_EQ(open.solid_relation({0, 0, 0}, 1.5), collision::kHit);
}

TEST(Surface, IsClosedByPlaceNotByIndexAndWhenRefit) {
  Mesh m = cube(1);
  Surface s = m.surface();
  ASSERT_TRUE(s.closed());
  m.points[0].x() -= 1e-9;
  s.refit(m.points);
  EXPECT_FALSE(s.closed());
  // Triangles that are lines or points take nothing from it.
  m = cube(1);
  for (const std::uint32_t c : {0, 0, 1, 2, 2, 2}) m.corners.push_back(c);
  EXPECT_TRUE(m.surface().closed());
  // Twice the same triangle closes nothing in, and an edge of four triangles is even.
  EXPECT_TRUE(Surface(m.points, std::vector<std::uint32_t>{0, 1, 2, 2, 1, 0}).closed());
  EXPECT_FALSE(Surface(m.points, std::vector<std::uint32_t>{0, 1, 2}).closed());
}

TEST(Surface, RefusesWhatIsNoMesh) {
  const Mesh m = cube(1);
  EXPECT_THROW(Surface(m.points, std::span(m.corners).first(4)), InvalidInput);
  std::vector<std::uint32_t> corners = m.corners;
  corners[7] = static_cast<std::uint32_t>(m.points.size());
  EXPECT_THROW(Surface(m.points, corners), InvalidInput);
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    std::vector<Vec3> points = m.points;
    points[5].y() = bad;
    EXPECT_THROW(Surface(points, m.corners), InvalidInput);
    Surface s = m.surface();
    EXPECT_THROW(s.refit(points), InvalidInput);
    EXPECT_THROW(s.refit(std::span(m.points).subspan(1)), InvalidInput);
    EXPECT_EQ(where(s, {0, 0, 0}), collision::kHit);
  }
}

TEST(Surface, SaysWhatItCannotAnswer) {
  const Surface s = cube(1).surface();
  const Answer not_finite = undecidable(Reason::not_finite);
  for (const double bad : {kNaN, kInfinity}) {
    const Vec3 x(0, bad, 0);
    EXPECT_EQ(where(s, x), not_finite);
    EXPECT_EQ(s.relation(point(x)), not_finite);
    EXPECT_EQ(s.relation(ball({0, 0, 0}, bad)), not_finite);
    EXPECT_EQ(s.relation(ball({0, 0, 0}, -1.0)), not_finite);
    EXPECT_EQ(s.nearest(point(x)).distance.answer, not_finite);
    EXPECT_TRUE(s.meetings(point(x)).empty());
  }
  const Surface none({}, {});
  EXPECT_EQ(none.nearest(point({0, 0, 0})).distance.answer, undecidable(Reason::degenerate));
  EXPECT_EQ(none.relation(point({0, 0, 0})), collision::kFree);
  EXPECT_EQ(where(none, {0, 0, 0}), collision::kFree);
}

/// At the ends of the range of doubles the cube is a cube still.
TEST(Surface, IsExactInUnitsOfEverySize) {
  for (const int exponent : {-1072, -300, 300, 1020}) {
    const auto scaled = [exponent](const Vec3& x) {
      return Vec3(std::ldexp(x.x(), exponent), std::ldexp(x.y(), exponent), std::ldexp(x.z(), exponent));
    };
    Mesh m = cube(2);
    for (Vec3& x : m.points) x = scaled(x);
    const Surface s = m.surface();
    EXPECT_EQ(where(s, scaled({0.25, 0.5, 0.75})), collision::kHit) << exponent;
    EXPECT_EQ(where(s, scaled({0.25, 0.5, 1.25})), collision::kFree) << exponent;
    EXPECT_EQ(where(s, scaled({0.25, 1, 1})), collision::kTouching) << exponent;
    EXPECT_EQ(s.solid_relation(scaled({0, 0, 1.5}), std::ldexp(0.5, exponent)), collision::kTouching)
        << exponent;
    const Distance d = s.nearest(point(scaled({0, 0, 1.5}))).distance;
    EXPECT_LE(d.lower, std::ldexp(0.5, exponent)) << exponent;
    EXPECT_GE(d.upper, std::ldexp(0.5, exponent)) << exponent;
    EXPECT_LE(d.upper, std::ldexp(0.75, exponent)) << exponent;
  }
}

}  // namespace
}  // namespace tendril::exact
