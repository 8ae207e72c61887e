#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/bspline.h>

#include <cmath>
#include <numeric>

#include "support/random.h"

namespace tendril {
namespace {

using test::Random;

/// Clamped on [0, 3] with simple, double and full-multiplicity interior knots.
KnotVector knots_of(int degree) {
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  knots.insert(knots.end(), {0.4, 1.0});
  if (degree > 1) knots.push_back(1.0);
  for (int i = 0; i < degree; ++i) knots.push_back(1.7);
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, 3.0);
  return KnotVector(degree, knots);
}

BSpline random_curve(int degree, std::uint64_t seed) {
  Random random(seed);
  const KnotVector knots = knots_of(degree);
  std::vector<Vec3> points(static_cast<std::size_t>(knots.control_points()));
  for (Vec3& p : points) p = random.in_cube();
  return BSpline(knots, points);
}

class EveryDegree : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, EveryDegree, testing::Values(1, 2, 3, 4, 5));

TEST_P(EveryDegree, BasisSumsToOneAndIsNotNegative) {
  const KnotVector knots = knots_of(GetParam());
  for (int i = 0; i <= 300; ++i) {
    const Basis basis = knots.basis(0.01 * i, 3);
    const auto sum = [&](std::size_t k) {
      return std::accumulate(basis.value[k].begin(), basis.value[k].end(), 0.0);
    };
    EXPECT_NEAR(sum(0), 1.0, 1e-15);
    for (std::size_t k = 1; k <= 3; ++k) EXPECT_NEAR(sum(k), 0.0, 1e-12 * std::pow(10.0, k));
    for (const double value : basis.value[0]) EXPECT_GE(value, 0.0);
  }
}

TEST_P(EveryDegree, ReproducesALineThroughGrevilleAbscissae) {
  const int p = GetParam();
  const KnotVector knots = knots_of(p);
  std::vector<Vec3> points;
  for (int i = 0; i < knots.control_points(); ++i) {
    double sum = 0.0;
    for (int j = 1; j <= p; ++j) sum += knots.knots()[static_cast<std::size_t>(i + j)];
    points.emplace_back(sum / p, 1.0, -sum / p);
  }
  const BSpline line(knots, points);
  for (int i = 0; i <= 60; ++i) {
    const double t = 0.05 * i;
    EXPECT_NEAR((line.value(t) - Vec3(t, 1.0, -t)).norm(), 0.0, 3e-15);
    EXPECT_NEAR((line.derivative(t) - Vec3(1, 0, -1)).norm(), 0.0, 3e-14);
  }
}

TEST_P(EveryDegree, DerivativesMatchCentralDifferences) {
  const BSpline curve = random_curve(GetParam(), 7);
  const double h = 1e-5;
  for (const double t : {0.2, 0.7, 1.3, 2.1, 2.9}) {
    const Vec3 first = (curve.value(t + h) - curve.value(t - h)) / (2 * h);
    EXPECT_NEAR((first - curve.derivative(t)).norm(), 0.0, 1e-7) << t;
    for (int order = 2; order <= 3; ++order) {
      const Vec3 next = (curve.derivative(t + h, order - 1) - curve.derivative(t - h, order - 1)) / (2 * h);
      EXPECT_NEAR((next - curve.derivative(t, order)).norm(), 0.0, 1e-5) << t << " order " << order;
    }
  }
}

TEST_P(EveryDegree, BezierPiecesAreTheCurve) {
  const BSpline curve = random_curve(GetParam(), 11);
  const auto pieces = curve.bezier_pieces();
  EXPECT_EQ(pieces.size(), 4u);
  for (const BezierPiece& piece : pieces) {
    for (int i = 0; i <= 8; ++i) {
      const double s = i / 8.0;
      std::vector<Vec3> d = piece.points;
      for (std::size_t n = d.size() - 1; n > 0; --n)
        for (std::size_t j = 0; j < n; ++j) d[j] = (1 - s) * d[j] + s * d[j + 1];
      const double t = piece.begin + s * (piece.end - piece.begin);
      EXPECT_NEAR((d[0] - curve.value(t)).norm(), 0.0, 2e-15);
    }
  }
}

TEST_P(EveryDegree, StaysInsideItsDomainAndKeepsItsEnds) {
  const BSpline curve = random_curve(GetParam(), 3);
  EXPECT_EQ(curve.value(-1.0), curve.control_points().front());
  EXPECT_EQ(curve.value(9.0), curve.control_points().back());
  EXPECT_EQ(curve.knots().span(3.0), curve.knots().control_points() - 1);
}

TEST(KnotVectorInput, IsRefusedWithThePlace) {
  const auto place = [](int degree, std::vector<double> knots) -> std::string {
    try {
      KnotVector(degree, std::move(knots));
    } catch (const InvalidInput& error) {
      return error.place();
    }
    return "accepted";
  };
  EXPECT_EQ(place(0, {0, 1}), "degree");
  EXPECT_EQ(place(6, std::vector<double>(14, 0)), "degree");
  EXPECT_EQ(place(2, {0, 0, 0, 1, 1}), "knots");
  EXPECT_EQ(place(1, {0, 0, std::nan(""), 1, 1}), "knots[2]");
  EXPECT_EQ(place(1, {0, 0, 0.5, 0.4, 1, 1}), "knots[3]");
  EXPECT_EQ(place(2, {0, 0, 0.1, 1, 1, 1}), "knots[2]");
  EXPECT_EQ(place(1, {0, 0, 0.5, 0.5, 1, 1}), "knots[2]");
  EXPECT_EQ(place(1, {1, 1, 1, 1}), "knots");
}

}  // namespace
}  // namespace tendril
