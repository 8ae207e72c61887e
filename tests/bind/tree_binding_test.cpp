#include <gtest/gtest.h>
#include <tendril/bind/binding.h>
#include <tendril/bind/mesh_follower.h>
#include <tendril/curve/closest_point.h>
#include <tendril/curve/fit.h>
#include <tendril/dynamics/rod.h>

#include <algorithm>

#include "axis/shapes.h"

namespace tendril::bind {
namespace {

/// On the knots of the chain at rest.
CurvePair pair_through(const std::vector<Vec3>& p, const std::vector<Vec3>& rest) {
  const std::vector<Vec3> q = orientation_towards(p, Vec3::UnitZ(), 0.1);
  const Interpolator fit(3, rest);
  return {fit.knots(), fit.solve(p), fit.solve(q)};
}

std::vector<Vec3> spine() {
  std::vector<Vec3> p;
  for (int k = 0; k <= 10; ++k) p.emplace_back(0, -1.0 + 0.2 * k, 0);
  return p;
}

/// A body along y, 0.4 thick, whose arm of 0.08 leaves it at the top and hangs down beside it: the flank is
/// nearer to the arm's axis than to the body's.
class Armed : public ::testing::Test {
 protected:
  /// \param lift  by how much the forearm is turned outwards about the elbow [rad]
  static std::vector<Vec3> arm(double lift = 0.0) {
    std::vector<Vec3> p;
    for (int k = 0; k <= 6; ++k) p.emplace_back(0.2 * k, 0.8, 0);
    p.emplace_back(1.3, 0.7, 0);
    const double angle = 0.6 - lift;  // hangs inwards
    for (int k = 1; k <= 6; ++k)
      p.push_back(Vec3(1.3, 0.7, 0) + 0.2 * k * Vec3(-std::sin(angle), -std::cos(angle), 0));
    return p;
  }
  static PolygonMesh make() {
    const std::vector<Vec3> limb = arm();
    const test::Field field = [&](const Vec3& p) {
      double least = test::capsule_field(p, Vec3(0, -1, 0), Vec3(0, 1, 0), 0.4);
      for (std::size_t k = 1; k < limb.size(); ++k)
        least = std::min(least, test::capsule_field(p, limb[k - 1], limb[k], 0.08));
      return least;
    };
    return test::Isosurface(field, Vec3(-0.51, -1.52, -0.53), Vec3(1.5, 1.5, 0.5), 0.0401).mesh();
  }

  const PolygonMesh mesh = make();
  const std::vector<CurvePair> rest{pair_through(spine(), spine()), pair_through(arm(), arm())};

  static bool on_flank(const Vec3& p) {
    return std::hypot(p.x(), p.z()) < 0.41 && p.y() < 0.2 && p.y() > -1.0;
  }
  static bool on_hand(const Vec3& p) { return p.x() > 0.5 && p.y() < 0.3; }
};

TEST_F(Armed, TheFlankIsNearerToTheArm) {
  const CurveProjector arm_axis(rest[1].primary()), body_axis(rest[0].primary());
  std::size_t nearer = 0;
  for (const Vec3& p : mesh.points)
    nearer += on_flank(p) && arm_axis.nearest(p).distance < body_axis.nearest(p).distance;
  EXPECT_GT(nearer, 30U);
}

TEST_F(Armed, TheFlankStaysWithTheBodyAndTheHandWithTheArm) {
  for (const BindMode mode : {BindMode::nearest, BindMode::continuous}) {
    const Binding binding(rest, mesh, {.mode = mode});
    const std::vector<CurvePair> posed{rest[0], pair_through(arm(0.8), arm())};
    std::vector<Vec3> out(mesh.points.size());
    MeshFollower(binding, std::vector<std::size_t>{0, 1}, out).follow(0.0, posed);
    double moved = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Vec3& p = mesh.points[i];
      if (on_flank(p)) {
        EXPECT_EQ(binding.pair_of(i), 0U);
        moved = std::max(moved, (out[i] - p).norm());
      }
      if (on_hand(p)) {
        EXPECT_EQ(binding.pair_of(i), 1U);
        EXPECT_GT((out[i] - p).norm(), 0.2) << p.transpose();
      }
    }
    EXPECT_LT(binding.report().rest_error, 1e-14);
    EXPECT_LT(moved, mode == BindMode::nearest ? 1e-12 : 0.01);
  }
}

TEST_F(Armed, ContinuousBindingDoesNotTearAtTheShoulder) {
  const std::vector<CurvePair> posed{rest[0], pair_through(arm(0.8), arm())};
  const auto largest = [&](BindMode mode) {
    const Binding binding(rest, mesh, {.mode = mode});
    std::vector<Vec3> out(mesh.points.size());
    binding.update(posed, out);
    double stretch = 0.0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.face(f)[k], b = mesh.face(f)[(k + 1) % 3];
        const double length = (mesh.points[a] - mesh.points[b]).norm();
        if (length > 0.004) stretch = std::max(stretch, (out[a] - out[b]).norm() / length);
      }
    return stretch;
  };
  EXPECT_LT(largest(BindMode::continuous), 4.0);
}

TEST_F(Armed, FollowsCurvePairsAnywhereInASimulation) {
  const Binding binding(rest, mesh, {.mode = BindMode::continuous});
  std::vector<Vec3> expected(mesh.points.size()), out(mesh.points.size());
  const CurvePair posed = pair_through(arm(0.3), arm());
  binding.update(std::vector<CurvePair>{rest[0], posed}, expected);
  MeshFollower(binding, std::vector<std::size_t>{2, 0}, out)
      .follow(0.0, std::vector<CurvePair>{posed, rest[0], rest[0]});
  EXPECT_EQ(out, expected);
  EXPECT_ANY_THROW(MeshFollower(binding, std::vector<std::size_t>{0}, out));
  MeshFollower beyond(binding, std::vector<std::size_t>{0, 3}, out);
  EXPECT_ANY_THROW(beyond.follow(0.0, std::vector<CurvePair>{posed, rest[0], rest[0]}));
}

/// The same mesh inside out: the islands are found by faces that look the other way than most.
TEST_F(Armed, DoesNotMindWhichWayFacesLook) {
  PolygonMesh flipped = mesh;
  for (std::size_t f = 0; f < flipped.face_count(); ++f)
    std::swap(flipped.corners[3 * f], flipped.corners[3 * f + 1]);
  const Binding one(rest, mesh, {.mode = BindMode::nearest});
  const Binding two(rest, flipped, {.mode = BindMode::nearest});
  for (std::size_t i = 0; i < mesh.points.size(); ++i) EXPECT_EQ(one.pair_of(i), two.pair_of(i));
}

/// Here the arm hangs down from a shoulder: its skin and the flank's run into each other in the armpit.
class Hanging : public ::testing::Test {
 protected:
  static std::vector<Vec3> arm(double lift = 0.0) {
    std::vector<Vec3> p{{0, 0.8, 0}, {0.2, 0.8, 0}, {0.4, 0.8, 0}, {0.55, 0.75, 0}};
    for (int k = 1; k <= 6; ++k)
      p.push_back(Vec3(0.62, 0.7, 0) + (0.2 * k - 0.1) * Vec3(std::sin(lift), -std::cos(lift), 0));
    return p;
  }
  static PolygonMesh mesh(double step) {
    const std::vector<Vec3> limb = arm();
    const test::Field field = [&](const Vec3& p) {
      double least = test::capsule_field(p, Vec3(0, -1, 0), Vec3(0, 1, 0), 0.4);
      for (std::size_t k = 1; k < limb.size(); ++k)
        least = std::min(least, test::capsule_field(p, limb[k - 1], limb[k], 0.08));
      return least;
    };
    return test::Isosurface(field, Vec3(-0.51, -1.52, -0.53), Vec3(0.8, 1.5, 0.5), step).mesh();
  }
};

TEST_F(Hanging, TheFlankStaysAndTheArmpitStretchesWithoutATear) {
  const std::vector<CurvePair> rest{pair_through(spine(), spine()), pair_through(arm(), arm())};
  const std::vector<CurvePair> posed{rest[0], pair_through(arm(0.8), arm())};
  std::vector<double> largest;
  for (const double step : {0.0401, 0.02005}) {
    const PolygonMesh body = mesh(step);
    const Binding binding(rest, body, {.mode = BindMode::continuous});
    std::vector<Vec3> out(body.points.size());
    binding.update(posed, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Vec3& p = body.points[i];
      if (std::hypot(p.x(), p.z()) < 0.41 && p.y() < 0.3)
        EXPECT_LT((out[i] - p).norm(), 1e-3) << p.transpose();
      if (p.x() > 0.53 && p.y() < 0.3) EXPECT_GT((out[i] - p).norm(), 0.2) << p.transpose();
    }
    double stretch = 0.0;
    for (std::size_t f = 0; f < body.face_count(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = body.face(f)[k], b = body.face(f)[(k + 1) % 3];
        const double length = (body.points[a] - body.points[b]).norm();
        if (length > 0.1 * step) stretch = std::max(stretch, (out[a] - out[b]).norm() / length);
      }
    largest.push_back(stretch);
  }
  EXPECT_LT(largest[0], 5.0);
  EXPECT_LT(largest[1], 1.3 * largest[0]);  // a tear's would double
}

}  // namespace
}  // namespace tendril::bind
