#include <gtest/gtest.h>
#include <tendril/collision/path_of_record.h>
#include <tendril/curve/axial.h>
#include <tendril/curve/fit.h>

#include <cmath>
#include <cstdio>

// The path of record against the true path of points bound to a rod that bends and twists at once.
namespace tendril {
namespace {

using collision::Passing;

constexpr int kNodes = 8;

/// A rod of length 1 bent along an arc of `angle`, and twisted by as much.
CurvePair posed(double angle) {
  std::vector<Vec3> primary, orientation;
  for (int i = 0; i < kNodes; ++i) {
    const double s = i / (kNodes - 1.0);
    const double a = angle * s;
    const Vec3 place =
        std::abs(angle) < 1e-12 ? Vec3(s, 0, 0) : Vec3(std::sin(a), 1 - std::cos(a), 0) / angle;
    const Vec3 across = std::cos(a) * Vec3(-std::sin(a), std::cos(a), 0) + std::sin(a) * Vec3(0, 0, 1);
    primary.push_back(place);
    orientation.push_back(place + 0.3 * across);
  }
  const Interpolator fit(3, primary);
  return {fit.knots(), fit.solve(primary), fit.solve(orientation)};
}

/// A bound point while the rod turns by `turn` from `angle` on, at the share `time` of the step.
struct Motion {
  AxialPoint record;
  double angle, turn;

  Vec3 at(double time) const { return from_axial(posed(angle + turn * time), record); }

  /// By central differences, extrapolated once: off by about 1e-12.
  Passing passing(double time) const {
    const auto difference = [&](double h) -> Vec3 { return (at(time + h) - at(time - h)) / (2 * h); };
    const double h = 1.0 / 64;
    return {at(time), (4 * difference(h / 2) - difference(h)) / 3};
  }

  double deviation() const {
    const auto path = collision::path_of_record(passing(0), passing(1), 1.0);
    double most = 0.0;
    for (int i = 0; i <= 64; ++i) {
      const double t = i / 64.0;
      const double s = 1 - t;
      const Vec3 p =
          s * s * s * path[0] + 3 * s * s * t * path[1] + 3 * s * t * t * path[2] + t * t * t * path[3];
      most = std::max(most, (p - at(t)).norm());
    }
    return most;
  }
};

double deviation(double turn) {
  double most = 0.0;
  for (const double t : {0.15, 0.5, 0.8, 1.0})
    for (const double angle : {0.1, 0.6, 1.1})
      most = std::max(most, Motion{{t, 0.08, -0.1, 0.0}, angle, turn}.deviation());
  return most;
}

TEST(PathOfRecord, KeepsItsEndsToTheLastBit) {
  const Motion motion{{0.7, 0.08, -0.1, 0.0}, 0.3, 0.1};
  const auto path = collision::path_of_record(motion.passing(0), motion.passing(1), 1.0);
  EXPECT_EQ(path.front(), motion.at(0));
  EXPECT_EQ(path.back(), motion.at(1));
}

TEST(PathOfRecord, IsExactForCubics) {
  const auto cubic = [](double t) { return Vec3(1 - t * t * t, t * t, 2 * t); };
  const auto slope = [](double t) { return Vec3(-3 * t * t, 2 * t, 2); };
  const auto path = collision::path_of_record({cubic(1), slope(1)}, {cubic(3), slope(3)}, 2.0);
  const Vec3 middle = (path[0] + 3 * path[1] + 3 * path[2] + path[3]) / 8;
  EXPECT_LT((middle - cubic(2)).norm(), 1e-14);
}

TEST(PathOfRecord, IsOfOrderFour) {
  const double coarse = deviation(0.2);
  const double middle = deviation(0.1);
  const double fine = deviation(0.05);
  std::printf("turning a step 0.2, 0.1, 0.05 rad: off by %.3g, %.3g, %.3g of the length, orders %.2f, %.2f\n",
              coarse, middle, fine, std::log2(coarse / middle), std::log2(middle / fine));
  EXPECT_LE(middle, 2e-5);
  EXPECT_GE(std::log2(coarse / middle), 3.8);
  EXPECT_GE(std::log2(middle / fine), 3.8);
}

}  // namespace
}  // namespace tendril
