#include "support/numbers.h"

#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/fit.h>
#include <tendril/curve/frame_jump.h>
#include <tendril/dynamics/rod.h>

namespace tendril {
namespace {

using Cause = FrameJump::Cause;
using tendril::test::kPi;

/// A half circle in the plane z = 0 from the origin to (0, 2, 0).
std::vector<Vec3> arch(int nodes) {
  std::vector<Vec3> p;
  for (int i = 0; i < nodes; ++i) {
    const double angle = kPi * i / (nodes - 1);
    p.emplace_back(std::sin(angle), 1 - std::cos(angle), 0);
  }
  return p;
}

std::vector<Vec3> straight(int nodes) {
  std::vector<Vec3> p;
  for (int i = 0; i < nodes; ++i) p.emplace_back(i, 0, 0);
  return p;
}

/// Turned by `angle` from each node to the next.
std::vector<Vec3> twisted(std::vector<Vec3> p, double angle) {
  for (std::size_t i = 0; i < p.size(); ++i)
    p[i] += rotate_about(Vec3::UnitX(), static_cast<double>(i) * angle, Vec3::UnitY());
  return p;
}

std::vector<Vec3> moved(std::vector<Vec3> p, const Vec3& by) {
  for (Vec3& x : p) x += by;
  return p;
}

std::optional<FrameJump> jump_of(const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
  const Interpolator fit(3, straight(static_cast<int>(p.size())));
  return find_frame_jump(CurvePair(fit.knots(), fit.solve(p), fit.solve(q)), fit.parameters());
}

TEST(FrameJump, IsFoundWhereTheOrientationPassesThroughTheCurve) {
  const std::vector<Vec3> p = arch(12);
  std::vector<Vec3> q;
  const PolygonTangents tangents = polygon_tangents(p);
  for (std::size_t i = 0; i < p.size(); ++i)
    q.push_back(p[i] + 0.3 * frame_towards(tangents.t[i], Vec3::UnitY()).frame.y);
  const auto jump = jump_of(p, q);
  ASSERT_TRUE(jump);
  EXPECT_EQ(jump->station, 5U);
  EXPECT_TRUE(jump->cause == Cause::flip || jump->cause == Cause::no_frame);
  EXPECT_NE(describe(*jump, "nodes").find("between nodes 5 and 6"), std::string::npos);
  EXPECT_FALSE(jump_of(p, moved(p, Vec3::UnitZ())));
}

TEST(FrameJump, IsFoundWhereTheCurveFoldsBack) {
  std::vector<Vec3> p = straight(11);
  for (int i = 6; i < 11; ++i) p[static_cast<std::size_t>(i)].x() = 10 - i;
  for (const double beside : {0.0, 0.02}) {
    std::vector<Vec3> bent = p;
    for (int i = 6; i < 11; ++i) bent[static_cast<std::size_t>(i)].z() = beside * (i - 5);
    const auto jump = jump_of(bent, moved(bent, Vec3::UnitY()));
    ASSERT_TRUE(jump);
    EXPECT_EQ(jump->cause, Cause::fold_back);
    EXPECT_TRUE(jump->station == 4 || jump->station == 5) << jump->station;
  }
}

TEST(FrameJump, IsFoundWhereThereIsNoFrame) {
  const std::vector<Vec3> p = straight(6);
  for (const std::vector<Vec3>& q : {p, moved(p, Vec3(0.5, 0, 0))}) {
    const auto jump = jump_of(p, q);
    ASSERT_TRUE(jump);
    EXPECT_EQ(jump->cause, Cause::no_frame);
  }
}

TEST(FrameJump, IsATurnBeyondARightAngleBetweenNodesButNotBetweenKnots) {
  const double right = 0.5 * kPi;
  EXPECT_FALSE(jump_of(straight(9), twisted(straight(9), 0.98 * right)));
  const auto jump = jump_of(straight(9), twisted(straight(9), 1.3 * right));
  ASSERT_TRUE(jump);
  EXPECT_EQ(jump->cause, Cause::turn);
  EXPECT_NEAR(jump->angle, 1.3 * right, 0.1);
  EXPECT_EQ(describe(*jump, "nodes").substr(0, 19), "the frame turns by ");
  // One span of degree 3, whose control points turn by 2 right angles in all.
  const std::vector<Vec3> p = straight(4), q = twisted(p, 2.0 / 3.0 * right);
  EXPECT_FALSE(find_frame_jump(CurvePair(KnotVector::uniform(3, 4), p, q)));
  EXPECT_TRUE(find_frame_jump(CurvePair(KnotVector::uniform(3, 4), p, p)));
  const std::vector<double> falling{1.0, 0.0};
  EXPECT_THROW(find_frame_jump(CurvePair(KnotVector::uniform(3, 4), p, q), falling), InvalidInput);
}

TEST(FrameJump, TurnsAreSignedAboutTheTangent) {
  const Frame frame;
  for (const double angle : {-3.0, -1.0, 0.0, 0.5, 2.0}) {
    const Vec3 y = rotate_about(frame.z, angle, frame.y);
    EXPECT_NEAR(turn_between(frame, {y.cross(frame.z), y, frame.z}), angle, 1e-14);
  }
}

TEST(Orientation, GivenAsADirectionStaysOnOneSideOfTheChain) {
  for (const int nodes : {8, 12, 50}) {
    try {
      orientation_towards(arch(nodes), Vec3::UnitY(), 0.1);
      ADD_FAILURE() << nodes << " nodes";
    } catch (const InvalidInput& error) {
      const std::string middle = std::to_string(nodes / 2 - 1) + " and " + std::to_string(nodes / 2);
      EXPECT_EQ(error.place(), "orientation between nodes " + middle);
    }
  }
  EXPECT_EQ(orientation_towards(arch(12), Vec3::UnitZ(), 0.1).size(), 12U);
  EXPECT_EQ(orientation_towards(arch(12), Vec3(0, 1, 0.3), 0.1).size(), 12U);
}

}  // namespace
}  // namespace tendril
