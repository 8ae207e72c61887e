#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/closest_point.h>

#include <cmath>
#include <limits>

#include "curve/minima_cases.h"

// The nearest points of many points at once are those of each alone, to the last bit.
namespace tendril {
namespace {

using test::HardPoints;
using test::NamedCurve;
using test::Random;

void expect_as_alone(const CurveProjector& projector, const std::vector<Vec3>& points,
                     const std::string& what) {
  const std::vector<Projection> many = projector.nearest(points);
  ASSERT_EQ(many.size(), points.size());
  int different = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    different += !test::same(many[i], projector.nearest(points[i]));
  EXPECT_EQ(different, 0) << what << ", of " << points.size();
}

/// Points on tubes around the curve, as the vertices of a mesh are.
std::vector<Vec3> tube(const BSpline& curve, int count, double radius) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / count, a = 2.399963 * i;
    const double t = curve.knots().start() + s * (curve.knots().end() - curve.knots().start());
    points.push_back(curve.value(t) +
                     radius * (1.0 + 0.2 * std::sin(40.0 * s)) * Vec3(std::cos(a), std::sin(a), 0.3));
  }
  return points;
}

TEST(NearestOfMany, IsThatOfEachOnHardCurves) {
  for (const NamedCurve& named : test::minima_curves()) {
    const CurveProjector projector(named.curve);
    HardPoints source(named.curve, projector, 77);
    std::vector<Vec3> points;
    for (int i = 0; i < 700; ++i) points.push_back(source.next());
    expect_as_alone(projector, points, named.name + ", hard points");
    const double size = test::diagonal(named.curve);
    for (const double radius : {1e-6, 0.05, 0.7})
      expect_as_alone(projector, tube(named.curve, 600, radius * size), named.name + ", tube");
  }
}

TEST(NearestOfMany, IsThatOfEachForAnyCount) {
  const NamedCurve named = test::minima_curves()[1];
  const CurveProjector projector(named.curve);
  const std::vector<Vec3> points = tube(named.curve, 2000, 0.3);
  for (const std::size_t count : {0, 1, 2, 7, 8, 31, 32, 33, 511, 512, 513, 544, 2000})
    expect_as_alone(projector, {points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)}, "tube");
}

/// More pieces than a group may choose from, and points for which all of them count.
TEST(NearestOfMany, IsThatOfEachOnALongCurve) {
  const BSpline helix = test::uniform_curve(3, test::along(6000, [](double s) {
                                              const double a = 1200.0 * s;
                                              return Vec3(std::cos(a), std::sin(a), 100.0 * s);
                                            }));
  const CurveProjector projector(helix);
  expect_as_alone(projector, tube(helix, 3000, 0.1), "near");
  Random random(5);
  std::vector<Vec3> far;
  for (int i = 0; i < 200; ++i) far.push_back(Vec3(0, 0, 50) + 1e3 * random.in_cube());
  expect_as_alone(projector, far, "far");
}

TEST(NearestOfMany, IsThatOfEachAtExtremeSizes) {
  const BSpline curve = test::uniform_curve(3, test::random_points(9, 8));
  Random random(6);
  for (const double scale : {1e-300, 1e-150, 1e-20, 1e20, 1e74, 1e140}) {
    std::vector<Vec3> u(curve.control_points().begin(), curve.control_points().end()), points;
    for (Vec3& x : u) x *= scale;
    for (int i = 0; i < 100; ++i) points.push_back(random.in_cube(6.0 * scale));
    for (int i = 0; i < 10; ++i) points.push_back(random.in_cube(1e5 * scale));
    points.insert(points.end(), 40, points.front());
    expect_as_alone(CurveProjector(BSpline(curve.knots(), u)), points, std::to_string(scale));
  }
}

TEST(NearestOfMany, NamesThePointThatIsNotANumber) {
  const CurveProjector projector(test::uniform_curve(3, test::random_points(9, 8)));
  std::vector<Vec3> points(50, Vec3(1, 2, 3));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    points[37].y() = bad;
    try {
      (void)projector.nearest(points);
      FAIL() << bad;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("points[37]"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tendril
