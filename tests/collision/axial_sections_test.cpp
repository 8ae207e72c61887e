#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/collision/axial_sections.h>
#include <tendril/collision/thesis_cylinder.h>

#include <cmath>
#include <numbers>

#include "support/random.h"

namespace tendril::collision {
namespace {

using test::Random;

/// Four control points, so three regions; farthest vertices by hand.
TEST(ThesisCylinder, IsLinearBetweenTheFarthestVerticesOfItsRegions) {
  const KnotVector knots = KnotVector::uniform(3, 4);
  const std::vector<AxialPoint> vertices{{0.1, 0.3, 0.4, 0.0}, {0.2, 0.1, 0.0, 0.0},  {0.5, 0.0, -1.0, 0.0},
                                         {0.6, 0.2, 0.2, 0.0}, {0.75, 0.0, 0.2, 0.0}, {1.0, 0.1, 0.0, 5.0}};
  const ThesisCylinder cylinder(vertices, knots);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.0), 0.0);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.05), 0.25);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.1), 0.5);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.3), 0.75);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.5), 1.0);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.625), 0.6);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.875), 0.1);
  EXPECT_DOUBLE_EQ(cylinder.radius(1.0), 0.0);
  EXPECT_TRUE(cylinder.holds({0.3, 0.0, 0.7, 0.0}));
  EXPECT_FALSE(cylinder.holds({0.3, 0.0, 0.8, 0.0}));
  EXPECT_FALSE(cylinder.holds(vertices[0]));  // a vertex that it goes through
  EXPECT_FALSE(cylinder.holds({0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(cylinder.holds({1.0, 0.0, 0.0, 0.0}));
}

TEST(ThesisCylinder, GivesAnEmptyRegionTheRadiusBeforeIt) {
  const KnotVector knots = KnotVector::uniform(3, 5);
  const std::vector<AxialPoint> vertices{{0.3, 0.5, 0.0, 0.0}, {0.9, 0.25, 0.0, 0.0}};
  const ThesisCylinder cylinder(vertices, knots);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.125), 0.0);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.3), 0.5);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.625), 0.5);
  EXPECT_DOUBLE_EQ(cylinder.radius(0.9), 0.25);
}

/// Triangles along a straight axis of length 1, some beyond its ends, where (t, w) is the place along it.
struct Soup {
  std::vector<Vec3> points;
  std::vector<AxialPoint> records;
  std::vector<Triangle> triangles;
};

AxialPoint record_of(const Vec3& p) {
  const double t = std::clamp(p.x(), 0.0, 1.0);
  return {t, p.y(), p.z(), p.x() - t};
}

Soup soup(Random& random) {
  Soup out;
  for (int i = 0; i < 30; ++i) {
    const Vec3 middle(random.uniform(-0.2, 1.2), random.uniform(0.0, 1.0), random.uniform(-0.1, 0.1));
    for (int k = 0; k < 3; ++k) {
      out.points.push_back(middle + random.in_cube(0.3));
      out.records.push_back(record_of(out.points.back()));
    }
    out.triangles.push_back({3U * i, 3U * i + 1, 3U * i + 2});
  }
  return out;
}

TEST(AxialSections, HoldTrianglesAlongAStraightCurve) {
  Random random(1);
  const KnotVector knots = KnotVector::uniform(3, 6);
  for (int i = 0; i < 20; ++i) {
    const Soup mesh = soup(random);
    for (const Section section : {Section::circle, Section::box, Section::octagon})
      for (const std::size_t regions : {1U, 7U, 64U}) {
        const AxialSections volume(mesh.records, mesh.triangles, knots, section, regions);
        int held = 0;
        for (const Triangle& t : mesh.triangles)
          for (int k = 0; k < 20; ++k) {
            const double a = std::sqrt(random.uniform());
            const double b = k < 2 ? k : random.uniform();
            const Vec3 p =
                (1 - a) * mesh.points[t[0]] + a * (1 - b) * mesh.points[t[1]] + a * b * mesh.points[t[2]];
            held += volume.holds(record_of(p));
          }
        EXPECT_EQ(held, 600);
        for (const AxialPoint& at : mesh.records) EXPECT_TRUE(volume.holds(at));
      }
  }
}

/// One triangle across: what each section holds about it.
TEST(AxialSections, HoldTheirShapesAndNoMore) {
  const KnotVector knots = KnotVector::uniform(3, 6);
  const std::vector<AxialPoint> records{{0.5, 1, 0, 0}, {0.5, -1, 0, 0}, {0.5, 0, 1, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const auto holds = [&](Section section, double t, double u, double v) {
    return AxialSections(records, triangles, knots, section, 10).holds({t, u, v, 0.0});
  };
  const Section circle = Section::circle, box = Section::box, octagon = Section::octagon;
  EXPECT_TRUE(holds(circle, 0.55, 0.7, -0.7) && holds(box, 0.55, 0.9, 0.9) &&
              holds(octagon, 0.55, 0.5, 0.49));
  EXPECT_FALSE(holds(circle, 0.55, 0.8, 0.8) || holds(box, 0.55, 0.9, -0.1) ||
               holds(octagon, 0.55, 0.6, 0.6));
  EXPECT_FALSE(holds(octagon, 0.55, -0.6, 0.6));
  EXPECT_FALSE(holds(circle, 0.65, 0, 0) || holds(box, 0.65, 0, 0.5) || holds(octagon, 0.65, 0, 0.5));
  EXPECT_FALSE(holds(circle, 0.0, 0, 0) || holds(box, 1.0, 0, 0.5));
}

TEST(AxialSections, EndWhereTheMeshEnds) {
  const KnotVector knots = KnotVector::uniform(3, 6);
  const std::vector<AxialPoint> records{{0, 1, 0, -0.5}, {0, -1, 0, -0.5}, {1, 0, 1, 0.25}};
  const AxialSections volume(records, std::vector<Triangle>{{0, 1, 2}}, knots, Section::box, 10);
  EXPECT_TRUE(volume.holds({0, 0.5, 0.5, -0.4}) && volume.holds({1, 0, 0.5, 0.2}));
  EXPECT_FALSE(volume.holds({0, 0.5, 0.5, -0.6}) || volume.holds({1, 0, 0.5, 0.3}));
}

TEST(AxialSections, RefuseBadInput) {
  const KnotVector knots = KnotVector::uniform(3, 6);
  const std::vector<AxialPoint> records(3);
  const std::vector<Triangle> triangles{{0, 1, 2}}, beyond{{0, 1, 3}};
  EXPECT_THROW(AxialSections(records, beyond, knots, Section::box, 4), InvalidInput);
  EXPECT_THROW(AxialSections(records, triangles, knots, Section::box, 0), InvalidInput);
  EXPECT_THROW(AxialSections(records, triangles, knots, Section::box, 4, -1.0), InvalidInput);
}

}  // namespace
}  // namespace tendril::collision
