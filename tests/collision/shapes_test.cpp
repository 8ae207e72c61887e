#include <gtest/gtest.h>
#include <tendril/exact/distance.h>

#include <cmath>

#include "collision/minkowski.h"
#include "support/random.h"

namespace tendril::exact {
namespace {

using test::Random;
using test::Ratio;
using test::Whole;

constexpr Kind kKinds[] = {Kind::point, Kind::segment, Kind::triangle, Kind::ball, Kind::capsule};

std::size_t points_of(Kind kind) {
  return kind == Kind::triangle ? 3 : kind == Kind::segment || kind == Kind::capsule ? 2 : 1;
}
Points corners(const Shape& s) {
  return Points(s.points).first(points_of(s.kind));
}
bool round(Kind kind) {
  return kind == Kind::ball || kind == Kind::capsule;
}

Ratio ratio(double x) {
  const Vec3 v(x, 0, 0);
  const int e = test::unit_exponent(Points(&v, 1));
  const Whole m = test::in_units(x, e);
  return e >= 0 ? Ratio(Whole(m << e)) : Ratio(m, Whole(1) << -e);
}

/// Square of the distance of the hulls of the shapes' corners.
Ratio true_square(const Shape& a, const Shape& b) {
  const int e = test::common_exponent(corners(a), corners(b));
  const Ratio square = test::minkowski_square(corners(a), corners(b), e);
  const Whole power = Whole(1) << 2 * std::abs(e);
  return e >= 0 ? square * Ratio(power) : square / Ratio(power);
}

Relation true_relation(const Shape& a, const Shape& b) {
  const Ratio radius = ratio(a.radius) + ratio(b.radius), square = true_square(a, b);
  if (radius == 0) return test::minkowski_relation(corners(a), corners(b));
  if (square == radius * radius) return Relation::touching;
  return square < radius * radius ? Relation::hit : Relation::free;
}

/// On a grid, so that shapes often touch and radii often fit; corners of one shape often coincide or lie on a
/// line.
Shape grid_shape(Random& random, Kind kind) {
  Shape s{kind, {}};
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) s.points[i][k] = random.integer(5);
  if (kind == Kind::triangle && random.integer(3) == 0) s.points[2] = 0.5 * (s.points[0] + s.points[1]);
  if (random.integer(8) == 0) s.points[1] = s.points[0];
  if (round(kind)) s.radius = 0.5 * random.integer(5);
  return s;
}

Shape random_shape(Random& random, Kind kind) {
  Shape s{kind, {random.in_cube(), random.in_cube(), random.in_cube()}};
  if (round(kind)) s.radius = random.uniform(0, 0.4);
  return s;
}

struct Kinds {
  Kind a, b;
};

class Pairs : public testing::TestWithParam<Kinds> {};

void expect_true(const Shape& a, const Shape& b, int seen[3]) {
  const Relation truth = true_relation(a, b);
  ++seen[static_cast<int>(truth)];
  EXPECT_EQ(relation(a, b), Answer{truth});
  EXPECT_EQ(relation(b, a), Answer{truth});
}

TEST_P(Pairs, OnAGridLieAsTheyTrulyDo) {
  Random random(11);
  int seen[3] = {};
  for (int i = 0; i < 400; ++i)
    expect_true(grid_shape(random, GetParam().a), grid_shape(random, GetParam().b), seen);
  EXPECT_GT(seen[0], 10);
  EXPECT_GT(seen[1] + seen[2], 2);
}

/// Radii that are the distance but for its rounding.
TEST_P(Pairs, AsFarApartAsTheirRadiiLieAsTheyTrulyDo) {
  Random random(12);
  int seen[3] = {};
  for (int i = 0; i < 150; ++i) {
    Shape a = random_shape(random, GetParam().a), b = random_shape(random, GetParam().b);
    a.radius = b.radius = 0;
    const double apart = std::sqrt(true_square(a, b).convert_to<double>());
    Shape& wide = round(a.kind) ? a : b;
    if (round(wide.kind)) wide.radius = i % 3 == 0 ? apart : std::nextafter(apart, i % 3 == 1 ? 0.0 : 9.0);
    expect_true(a, b, seen);
  }
  if (round(GetParam().a) || round(GetParam().b)) EXPECT_GT(seen[2], 10);
  EXPECT_GT(seen[0], 10);
}

/// In units that make all numbers extreme, relations are those of the same shapes in ordinary units.
TEST_P(Pairs, AreTheSameInUnitsOfEverySize) {
  Random random(13);
  for (int i = 0; i < 60; ++i) {
    const Shape a = grid_shape(random, GetParam().a), b = grid_shape(random, GetParam().b);
    for (const int exponent : {-1073, -600, -150, 150, 600, 1019}) {
      Shape p = a, q = b;
      for (Shape* s : {&p, &q}) {
        for (Vec3& x : s->points)
          x = Vec3(std::ldexp(x[0], exponent), std::ldexp(x[1], exponent), std::ldexp(x[2], exponent));
        s->radius = std::ldexp(s->radius, exponent);
      }
      EXPECT_EQ(relation(p, q), relation(a, b)) << exponent;
    }
  }
}

/// lower <= true distance <= upper, in rationals, and the gap that the header states.
void expect_bounds(const Shape& a, const Shape& b) {
  const Distance d = distance(a, b);
  const Ratio square = true_square(a, b), radius = ratio(a.radius) + ratio(b.radius);
  EXPECT_EQ(d.answer, relation(a, b));
  if (d.answer.relation != Relation::free) {
    EXPECT_EQ(d.lower, 0.0);
    EXPECT_EQ(d.upper, 0.0);
    return;
  }
  const Ratio low = ratio(d.lower) + radius, high = ratio(d.upper) + radius;
  EXPECT_LE(low * low, square);
  EXPECT_GE(high * high, square);
  EXPECT_GT(d.upper, 0.0);
  EXPECT_LE(d.upper - d.lower, 0x1p-40 * std::sqrt(square.convert_to<double>()));
  EXPECT_NEAR((d.on_a - d.on_b).norm(), std::sqrt(square.convert_to<double>()), 1e-7);
}

TEST_P(Pairs, HaveDistancesWithinTheirBounds) {
  Random random(14);
  for (int i = 0; i < 60; ++i) {
    expect_bounds(grid_shape(random, GetParam().a), grid_shape(random, GetParam().b));
    expect_bounds(random_shape(random, GetParam().a), random_shape(random, GetParam().b));
  }
}

/// So near that differences of doubles say little: the gap is relative to the distance all the same.
TEST_P(Pairs, HaveDistancesWithinTheirBoundsWhenNearlyTouching) {
  Random random(15);
  for (int i = 0; i < 60; ++i) {
    Shape a = random_shape(random, GetParam().a), b = random_shape(random, GetParam().b);
    a.radius = b.radius = 0;
    const Distance d = distance(a, b);
    if (d.answer.relation != Relation::free) continue;
    for (Vec3& x : b.points) x += (1 - 1e-12) * (d.on_a - d.on_b);
    expect_bounds(a, b);
  }
}

TEST(Shapes, ZeroHasNoSign) {
  EXPECT_EQ(relation(point({0.0, 1, -0.0}), point({-0.0, 1, 0.0})), collision::kTouching);
  const Segment s{Vec3(-0.0, 0, 0), Vec3(1, 0, 0)};
  EXPECT_EQ(relation(segment(s), segment({Vec3(0.0, 0, 0), Vec3(-1, 0, 0)})), collision::kTouching);
  EXPECT_EQ(relation(ball({0, 0, 0}, -0.0), point({0, 0, 0})), collision::kTouching);
}

std::vector<Kinds> all_pairs() {
  std::vector<Kinds> out;
  for (const Kind a : kKinds)
    for (const Kind b : kKinds) out.push_back({a, b});
  return out;
}

std::string name_of(const testing::TestParamInfo<Kinds>& pair) {
  constexpr const char* kNames[] = {"Point", "Segment", "Triangle", "Ball", "Capsule"};
  return std::string(kNames[static_cast<int>(pair.param.a)]) + kNames[static_cast<int>(pair.param.b)];
}

INSTANTIATE_TEST_SUITE_P(Kinds, Pairs, testing::ValuesIn(all_pairs()), name_of);

}  // namespace
}  // namespace tendril::exact
