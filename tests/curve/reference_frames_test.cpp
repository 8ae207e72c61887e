#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/reference_frames.h>

#include <cmath>
#include <numbers>

#include "curve/projection_cases.h"
#include "support/frames.h"
#include "support/numbers.h"

namespace tendril {
namespace {

using test::departure;
using test::kNaN;

constexpr double kStart = -1.0, kEnd = 2.0;

/// The polynomial helix (3 t - t^3, 3 t^2, 3 t + t^3): its tangent is at 45 degrees to the z axis, and its
/// curvature and torsion are both 1 / (3 (1 + t^2)^2). One cubic piece, by its blossom.
BSpline helix() {
  const auto blossom = [](double a, double b, double c) {
    const double t = (a + b + c) / 3, t2 = (a * b + b * c + c * a) / 3, t3 = a * b * c;
    return Vec3(3 * t - t3, 3 * t2, 3 * t + t3);
  };
  const double a = kStart, b = kEnd;
  return BSpline(KnotVector(3, {a, a, a, a, b, b, b, b}),
                 {blossom(a, a, a), blossom(a, a, b), blossom(a, b, b), blossom(b, b, b)});
}

struct Exact {
  Vec3 tangent, normal, binormal;
  double curvature;
};

Exact exact(double t) {
  const double q = 1 + t * t;
  const Vec3 tangent = Vec3(1 - t * t, 2 * t, q) / (std::numbers::sqrt2 * q);
  const Vec3 normal = Vec3(-2 * t, 1 - t * t, 0) / q;
  return {tangent, normal, tangent.cross(normal), 1.0 / (3 * q * q)};
}

/// The rotation-minimising direction that is the normal at kStart: it turns against the Frenet frame by the
/// integral of the torsion along the arc, sqrt(2) (atan t - atan kStart).
Vec3 exact_minimising(double t) {
  const double angle = -std::numbers::sqrt2 * (std::atan(t) - std::atan(kStart));
  return std::cos(angle) * exact(t).normal + std::sin(angle) * exact(t).binormal;
}

double minimising_error(int steps) {
  std::vector<double> parameters;
  for (int i = 0; i <= steps; ++i) parameters.push_back(kStart + (kEnd - kStart) * i / steps);
  const NodeFrames frames = rotation_minimising_frames(helix(), parameters, exact(kStart).normal);
  double worst = 0.0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_EQ(frames.status[i], FrameStatus::ok);
    EXPECT_LT(departure(frames.frame[i]), 1e-14);
    worst = std::max(worst, (frames.frame[i].y - exact_minimising(parameters[i])).norm());
  }
  return worst;
}

TEST(FrenetFrameOf, AHelixHasItsClosedForm) {
  for (int i = 0; i <= 60; ++i) {
    const double t = kStart + 0.05 * i;
    const FrenetFrame at = frenet_frame(helix(), t);
    ASSERT_EQ(at.status, FrameStatus::ok);
    EXPECT_NEAR((at.frame.z - exact(t).tangent).norm(), 0.0, 1e-14);
    EXPECT_NEAR((at.frame.y - exact(t).normal).norm(), 0.0, 1e-13);
    EXPECT_NEAR((at.frame.x + exact(t).binormal).norm(), 0.0, 1e-13);
    EXPECT_NEAR(at.curvature, exact(t).curvature, 1e-13);
    EXPECT_NEAR(at.torsion, exact(t).curvature, 1e-13);
  }
}

TEST(FrenetFrameOf, ALineAnInflectionAndARestAreReported) {
  const BSpline line =
      test::uniform_curve(3, test::along(10, [](double s) { return Vec3(3 * s, 0.1 * s, -7 * s); }));
  for (const double t : {0.0, 0.31, 0.5, 1.0}) {
    EXPECT_NE(frenet_frame(line, t).status, FrameStatus::ok) << t;
    EXPECT_EQ(frenet_frame(line, t).curvature, 0.0);
    EXPECT_LT(departure(frenet_frame(line, t).frame), 1e-14);
  }
  // y = x^3 on [-1, 1] bends at 0 to neither side; (x^2, x^3) is at rest there, facing along x^2.
  const KnotVector knots(3, {-1, -1, -1, -1, 1, 1, 1, 1});
  const double third = 1.0 / 3;
  const BSpline bend(knots, {{-1, -1, 0}, {-third, 1, 0}, {third, -1, 0}, {1, 1, 0}});
  EXPECT_NE(frenet_frame(bend, 0.0).status, FrameStatus::ok);
  EXPECT_EQ(frenet_frame(bend, 0.01).status, FrameStatus::ok);
  const BSpline cusp(knots, {{1, -1, 0}, {-third, 1, 0}, {-third, -1, 0}, {1, 1, 0}});
  const FrenetFrame rest = frenet_frame(cusp, 0.0);
  EXPECT_EQ(rest.status, FrameStatus::zero_speed);
  EXPECT_NEAR(rest.frame.z.x(), 1.0, 1e-14);
  EXPECT_LT(departure(rest.frame), 1e-14);
  EXPECT_EQ(directional_frame(cusp, 0.0, Vec3::UnitZ()).status, FrameStatus::zero_speed);
}

TEST(FrenetFrameOf, ARestAtAnEndLooksAlongTheCurve) {
  const BSpline curve =
      test::uniform_curve(3, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 3, 0}, {2, 4, 0}, {2, 4, 0}});
  for (const double t : {0.0, 1.0}) {
    const FrenetFrame at = frenet_frame(curve, t);
    EXPECT_EQ(at.status, FrameStatus::zero_speed);
    EXPECT_NEAR((at.frame.z - (t == 0.0 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY()))).norm(), 0.0, 1e-14);
  }
}

TEST(RotationMinimisingFrames, ConvergeToTheExactOnesWithTheFourthPowerOfTheStep) {
  double before = minimising_error(16);
  for (const int steps : {32, 64, 128, 256}) {
    const double error = minimising_error(steps);
    EXPECT_GT(before / error, 14.0) << steps;
    EXPECT_LT(before / error, 18.0) << steps;
    before = error;
  }
  EXPECT_LT(before, 1e-8);
}

TEST(RotationMinimisingFrames, KeepTheirDirectionAlongALineAndAcrossAPause) {
  const BSpline line = test::uniform_curve(3, test::along(9, [](double s) { return Vec3(3 * s, 0, 0); }));
  const std::vector<double> parameters{0.0, 0.2, 0.2, 0.9};
  const NodeFrames frames = rotation_minimising_frames(line, parameters, Vec3(5, 1, 1));
  for (const Frame& frame : frames.frame)
    EXPECT_NEAR((frame.y - Vec3(0, 1, 1).normalized()).norm(), 0.0, 1e-15);
  EXPECT_EQ(frames.status[1], FrameStatus::ok);
  EXPECT_EQ(frames.status[2], FrameStatus::zero_edge);
}

/// From the middle of the first edge of a Z to that of the last: equal tangents across the step, so that the
/// second reflection has no plane.
TEST(RotationMinimisingFrames, WithoutASecondReflectionAreReported) {
  const BSpline z(KnotVector(1, {0, 0, 1, 2, 3, 3}), {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {2, 1, 0}});
  const std::vector<double> parameters{0.5, 2.5};
  const NodeFrames frames = rotation_minimising_frames(z, parameters, Vec3(0, 1, 1));
  EXPECT_EQ(frames.status[1], FrameStatus::fold_back);
  EXPECT_LT(departure(frames.frame[1]), 1e-14);
}

TEST(RotationMinimisingFrames, AreFramesOnEveryCurve) {
  for (const test::NamedCurve& named : test::projection_curves()) {
    std::vector<double> parameters;
    const double a = named.curve.knots().start(), b = named.curve.knots().end();
    for (int i = 0; i <= 400; ++i) parameters.push_back(a + (b - a) * i / 400);
    const NodeFrames frames = rotation_minimising_frames(named.curve, parameters, Vec3(0.1, 0.2, 1));
    ASSERT_EQ(frames.frame.size(), 401u);
    for (const Frame& frame : frames.frame) EXPECT_LT(departure(frame), 1e-14) << named.name;
  }
}

TEST(DirectionalFrame, PutsTheDirectionInItsYZPlane) {
  const Vec3 d(0.3, -2.0, 0.4);
  for (int i = 0; i <= 30; ++i) {
    const double t = kStart + 0.1 * i;
    const FrameChoice at = directional_frame(helix(), t, d);
    ASSERT_EQ(at.status, FrameStatus::ok);
    EXPECT_LT(departure(at.frame), 1e-14);
    EXPECT_NEAR((at.frame.x - d.cross(exact(t).tangent).normalized()).norm(), 0.0, 1e-13);
    EXPECT_GT(at.frame.y.dot(d), 0.0);
  }
}

TEST(DirectionalFrame, AlongTheTangentIsReported) {
  const BSpline curve = helix();
  const FrameChoice at = directional_frame(curve, 0.5, -3.0 * curve.derivative(0.5));
  EXPECT_EQ(at.status, FrameStatus::offset_along_tangent);
  EXPECT_LT(departure(at.frame), 1e-14);
  EXPECT_NEAR(directional_frame(curve, 0.5, exact(0.5).tangent + 1e-6 * exact(0.5).normal).sine, 1e-6, 1e-9);
}

TEST(ReferenceFrameInput, IsRefused) {
  const std::vector<double> none, falling{0.5, 0.2}, nan{0.0, kNaN}, fine{0.0, 0.2};
  EXPECT_THROW(directional_frame(helix(), 0.0, Vec3::Zero()), InvalidInput);
  EXPECT_THROW(directional_frame(helix(), 0.0, Vec3(0, kNaN, 0)), InvalidInput);
  EXPECT_THROW(rotation_minimising_frames(helix(), none, Vec3::UnitX()), InvalidInput);
  EXPECT_THROW(rotation_minimising_frames(helix(), falling, Vec3::UnitX()), InvalidInput);
  EXPECT_THROW(rotation_minimising_frames(helix(), nan, Vec3::UnitX()), InvalidInput);
  EXPECT_THROW(rotation_minimising_frames(helix(), fine, Vec3::Zero()), InvalidInput);
}

}  // namespace
}  // namespace tendril
