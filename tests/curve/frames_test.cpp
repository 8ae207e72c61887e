#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/axial.h>
#include <tendril/curve/manipulate.h>

#include <cmath>
#include <numbers>

#include "support/frames.h"
#include "support/random.h"

namespace tendril {
namespace {

using test::departure;
using test::Random;

CurvePair random_pair(std::uint64_t seed, int points) {
  Random random(seed);
  std::vector<Vec3> u;
  std::vector<Vec3> v;
  for (int i = 0; i < points; ++i) {
    u.push_back(Vec3(i, 0, 0) + random.in_cube(0.8));
    v.push_back(u.back() + Vec3(0, 0.5, 0.5) + random.in_cube(0.3));
  }
  return CurvePair(KnotVector::uniform(3, points), u, v);
}

TEST(CurveFrame, IsOrthonormalAndTurnsTowardsTheOrientationCurve) {
  const CurvePair pair = random_pair(1, 9);
  for (int i = 0; i <= 200; ++i) {
    const double t = i / 200.0;
    const CurveFrame at = pair.frame(t);
    ASSERT_EQ(at.status, FrameStatus::ok);
    EXPECT_LT(departure(at.frame), 2e-15);
    const Vec3 n = pair.orientation().value(t) - at.origin;
    EXPECT_GT(n.dot(at.frame.y), 0.0);
    EXPECT_NEAR(n.dot(at.frame.x), 0.0, 1e-15);
    EXPECT_NEAR(pair.primary().derivative(t).normalized().cross(at.frame.z).norm(), 0.0, 1e-15);
    EXPECT_NEAR(at.sine, n.normalized().cross(at.frame.z).norm(), 1e-15);
  }
}

TEST(CurveFrame, DegeneraciesAreReportedAndStillFrames) {
  const KnotVector knots = KnotVector::uniform(3, 5);
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  std::vector<Vec3> stalled{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}};
  std::vector<Vec3> above = line;
  for (Vec3& q : above) q.z() += 1.0;
  const auto check = [](const CurvePair& pair, FrameStatus expected) {
    const CurveFrame at = pair.frame(0.0);
    EXPECT_EQ(at.status, expected);
    EXPECT_LT(departure(at.frame), 2e-15);
  };
  check(CurvePair(knots, line, above), FrameStatus::ok);
  check(CurvePair(knots, line, line), FrameStatus::zero_offset);
  std::vector<Vec3> ahead = line;
  for (Vec3& q : ahead) q.x() += 1.0;
  check(CurvePair(knots, line, ahead), FrameStatus::offset_along_tangent);
  check(CurvePair(knots, stalled, above), FrameStatus::zero_speed);
  // The limit of the tangent at the stalled start is the direction of c''.
  EXPECT_NEAR((CurvePair(knots, stalled, above).frame(0.0).frame.z - Vec3::UnitY()).norm(), 0.0, 1e-15);
  check(CurvePair(knots, std::vector<Vec3>(5, Vec3::Ones()), above), FrameStatus::zero_speed);
}

TEST(AxialRecord, ReturnsTheRestShape) {
  const CurvePair pair = random_pair(2, 30);
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 around = random.in_cube(3);
    const Vec3 point = Vec3(random.uniform(-2, 32), 0, 0) + around;
    const AxialPoint record = to_axial(pair, random.uniform(), point);
    EXPECT_LT((from_axial(pair, record) - point).norm(), 1e-13 * 30);
  }
}

TEST(AxialRecord, MovesRigidlyWithItsPair) {
  const CurvePair pair = random_pair(3, 9);
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  const auto moved = [&](const Vec3& p) { return Vec3(rotate_about(axis, 1.1, p) + Vec3(5, -7, 2)); };
  std::vector<Vec3> u;
  std::vector<Vec3> v;
  for (const Vec3& p : pair.primary().control_points()) u.push_back(moved(p));
  for (const Vec3& p : pair.orientation().control_points()) v.push_back(moved(p));
  const CurvePair other(pair.knots(), u, v);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = Vec3(4, 0, 0) + random.in_cube(4);
    const AxialPoint record = to_axial(pair, random.uniform(), point);
    EXPECT_LT((from_axial(other, record) - moved(point)).norm(), 2e-14);
  }
}

TEST(PolygonTangent, BisectsAndReportsDegeneracies) {
  const std::vector<Vec3> p{{0, 0, 0}, {2, 0, 0}, {2, 5, 0}, {2, 5, 0}, {2, 2, 0}, {2, 9, 0}};
  const PolygonTangents tangents = polygon_tangents(p);
  EXPECT_EQ(tangents.t[0], Vec3::UnitX());
  EXPECT_NEAR((tangents.t[1] - Vec3(1, 1, 0).normalized()).norm(), 0.0, 1e-15);
  EXPECT_EQ(tangents.status[1], FrameStatus::ok);
  EXPECT_EQ(tangents.status[2], FrameStatus::zero_edge);
  EXPECT_EQ(tangents.t[2], Vec3::UnitY());
  EXPECT_EQ(tangents.status[4], FrameStatus::fold_back);
  EXPECT_EQ(tangents.t[4], Vec3(-Vec3::UnitY()));
  EXPECT_THROW(polygon_tangents(Points(p).first(1)), InvalidInput);
}

TEST(SmallestRotation, CarriesTheDirectionAndKeepsLengths) {
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 a = random.in_cube().normalized();
    Vec3 b = random.in_cube();
    if (i % 5 == 0) b = -a + std::pow(10.0, -random.uniform(1, 5)) * b;
    b.normalize();
    const Vec3 v = random.in_cube();
    EXPECT_NEAR((rotate_smallest(a, b, a) - b).norm(), 0.0, 2e-15 / std::max(1e-12, (a + b).norm()));
    EXPECT_NEAR(rotate_smallest(a, b, v).norm(), v.norm(), 2e-15 / std::max(1e-12, (a + b).norm()));
    // Vectors along the axis stay.
    const Vec3 axis = a.cross(b);
    EXPECT_NEAR((rotate_smallest(a, b, axis) - axis).norm(), 0.0, 1e-15);
  }
  const Vec3 a = Vec3(1, 2, 2) / 3;
  EXPECT_NEAR((rotate_smallest(a, -a, a) + a).norm(), 0.0, 1e-15);
}

TEST(Manipulation, MovingAPointKeepsEveryOffsetInItsNodeFrame) {
  PolygonPair pair;
  Random random(21);
  for (int i = 0; i < 8; ++i) {
    pair.p.push_back(Vec3(2.0 * i, 0, 0) + random.in_cube(0.5));
    pair.q.push_back(pair.p.back() + Vec3(0.2, 1, 0) + random.in_cube(0.2));
  }
  for (const std::size_t i : {0u, 3u, 7u}) {
    const PolygonPair before = pair;
    ASSERT_EQ(move_point(pair, i, pair.p[i] + Vec3(0.3, -1.1, 0.8)), FrameStatus::ok);
    const PolygonTangents was = polygon_tangents(before.p);
    const PolygonTangents is = polygon_tangents(pair.p);
    for (std::size_t k = 0; k < 8; ++k) {
      const Vec3 v = before.q[k] - before.p[k];
      const Vec3 w = pair.q[k] - pair.p[k];
      EXPECT_NEAR(w.norm(), v.norm(), 1e-14);
      EXPECT_NEAR(w.dot(is.t[k]), v.dot(was.t[k]), 1e-14);
      // Thesis 2.9: no twist about the tangent.
      EXPECT_NEAR((w - rotate_smallest(was.t[k], is.t[k], v)).norm(), 0.0, 1e-14);
      const bool far = k + 1 < i || k > i + 1;
      EXPECT_TRUE(!far || pair.q[k] == before.q[k]);
    }
  }
}

TEST(Manipulation, TwistTurnsTheNodeFrameByTheAngle) {
  PolygonPair pair{{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}}, {{0, 1, 0}, {1, 1, 0}, {2, 2, 0}}};
  const NodeFrames before = node_frames(pair.p, pair.q);
  ASSERT_EQ(twist_point(pair, 1, std::numbers::pi / 3), FrameStatus::ok);
  const NodeFrames after = node_frames(pair.p, pair.q);
  EXPECT_NEAR(before.frame[1].y.dot(after.frame[1].y), 0.5, 1e-15);
  EXPECT_GT(before.frame[1].y.cross(after.frame[1].y).dot(after.frame[1].z), 0.0);
  EXPECT_NEAR((before.frame[0].y - after.frame[0].y).norm(), 0.0, 0.0);
  EXPECT_THROW(twist_point(pair, 3, 1.0), InvalidInput);
  EXPECT_THROW(move_point(pair, 0, Vec3(std::nan(""), 0, 0)), InvalidInput);
}

}  // namespace
}  // namespace tendril
