#include <gtest/gtest.h>
#include <tendril/bind/judge.h>
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
  for (const double band : {0.25, BindOptions{}.band}) {
    const double flank = band > 0.25 ? 0.17 : 0.28;  // up to where the zone is that the arm pulls along
    std::vector<double> largest;
    for (const double step : {0.0401, 0.02005}) {
      const PolygonMesh body = mesh(step);
      const Binding binding(rest, body, {.band = band});
      std::vector<Vec3> out(body.points.size());
      binding.update(posed, out);
      for (std::size_t i = 0; i < out.size(); ++i) {
        const Vec3& p = body.points[i];
        if (std::hypot(p.x(), p.z()) < 0.41 && p.y() < flank)
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
}

/// Triangles of a closed box, each face cut into squares of about `size`.
void add_box(const Vec3& low, const Vec3& high, double size, PolygonMesh& mesh) {
  for (Eigen::Index a = 0; a < 3; ++a)
    for (const bool top : {false, true}) {
      const Eigen::Index b = (a + 1) % 3, c = (a + 2) % 3;
      const int nb = 1 + static_cast<int>((high[b] - low[b]) / size),
                nc = 1 + static_cast<int>((high[c] - low[c]) / size);
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (int i = 0; i <= nb; ++i)
        for (int k = 0; k <= nc; ++k) {
          Vec3 p;
          p[a] = top ? high[a] : low[a];
          p[b] = i == nb ? high[b] : low[b] + (high[b] - low[b]) * i / nb;
          p[c] = k == nc ? high[c] : low[c] + (high[c] - low[c]) * k / nc;
          mesh.points.push_back(p);
        }
      for (int i = 0; i < nb; ++i)
        for (int k = 0; k < nc; ++k) {
          const auto at = [&](int x, int y) { return first + static_cast<std::uint32_t>(x * (nc + 1) + y); };
          std::array<std::uint32_t, 4> q{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)};
          if (!top) std::reverse(q.begin(), q.end());
          mesh.corners.insert(mesh.corners.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
          for (int n = 0; n < 2; ++n) mesh.face_begin.push_back(mesh.face_begin.back() + 3);
        }
    }
}

std::vector<Vec3> chain(const Vec3& from, const Vec3& to, int count) {
  std::vector<Vec3> p;
  for (int i = 0; i < count; ++i) p.push_back(from + (to - from) * i / (count - 1));
  return p;
}

/// A palm with two fingers along x, far less than a voxel of the grid apart.
struct Hand {
  PolygonMesh mesh;
  std::vector<CurvePair> rest;

  explicit Hand(double gap) {
    add_box(Vec3(-1.5, -0.5, -0.2), Vec3(0.1, 0.5, 0.2), 0.1, mesh);
    add_box(Vec3(0.0, 0.5 * gap, -0.15), Vec3(2.0, 0.4, 0.15), 0.1, mesh);
    add_box(Vec3(0.0, -0.4, -0.15), Vec3(2.0, -0.5 * gap, 0.15), 0.1, mesh);
    for (const auto& p :
         {chain(Vec3(-1.4, 0, 0), Vec3(-0.2, 0, 0), 5), chain(Vec3(-0.1, 0.2, 0), Vec3(1.9, 0.2, 0), 8),
          chain(Vec3(-0.1, -0.15, 0), Vec3(1.9, -0.15, 0), 8)})
      rest.push_back(pair_through(p, p));
  }
};

TEST(Fingers, SideBySideKeepToTheirOwnAxes) {
  for (const double gap : {0.02, 1e-4, 1e-9}) {
    const Hand hand(gap);
    const Binding binding(hand.rest, hand.mesh, {});
    for (std::size_t i = 0; i < hand.mesh.points.size(); ++i) {
      const Vec3& p = hand.mesh.points[i];
      if (p.x() > 0.6) EXPECT_EQ(binding.pair_of(i), p.y() > 0.0 ? 1U : 2U) << gap << ": " << p.transpose();
    }
    EXPECT_LT(binding.report().rest_error, 1e-14);
  }
}

/// The ball sits beside the axis of the upper finger, on its skin: all of it follows that one, rigidly.
TEST(LooseParts, FollowWholeTheLimbTheySitOn) {
  Hand hand(0.02);
  const std::size_t first = hand.mesh.points.size();
  add_box(Vec3(1.0, 0.16, 0.14), Vec3(1.06, 0.24, 0.2), 0.03, hand.mesh);
  const Binding binding(hand.rest, hand.mesh, {});
  std::vector<CurvePair> posed = hand.rest;
  std::vector<Vec3> bent = chain(Vec3(-0.1, 0.2, 0), Vec3(1.9, 0.2, 0), 8);
  for (std::size_t i = 0; i < bent.size(); ++i) bent[i].y() += 0.08 * static_cast<double>(i * i) / 8.0;
  posed[1] = pair_through(bent, chain(Vec3(-0.1, 0.2, 0), Vec3(1.9, 0.2, 0), 8));
  std::vector<Vec3> out(hand.mesh.points.size());
  binding.update(posed, out);
  for (std::size_t i = first; i < out.size(); ++i) {
    EXPECT_EQ(binding.pair_of(i), 1U);
    EXPECT_EQ(binding.records()[i].t, binding.records()[first].t);
    for (std::size_t k = first; k < i; ++k)
      EXPECT_NEAR((out[i] - out[k]).norm(), (hand.mesh.points[i] - hand.mesh.points[k]).norm(), 1e-14);
    EXPECT_GT((out[i] - hand.mesh.points[i]).norm(), 0.1);
  }
  ASSERT_EQ(binding.report().loose.size(), 1u);
  const LoosePart& part = binding.report().loose[0];
  EXPECT_EQ(part.first, first);
  EXPECT_EQ(part.points, out.size() - first);
  EXPECT_EQ(part.pair, 1u);
  EXPECT_EQ(part.t, binding.records()[first].t);
}

/// What a vertex is bound to is a function of its place on the surface.
TEST_F(Hanging, SplittingEdgesMovesNoBoundVertex) {
  const std::vector<CurvePair> rest{pair_through(spine(), spine()), pair_through(arm(), arm())};
  const std::vector<CurvePair> posed{rest[0], pair_through(arm(0.8), arm())};
  PolygonMesh body = mesh(0.0801);
  std::vector<Vec3> before(body.points.size()), out;
  Binding(rest, body, {}).update(posed, before);
  for (int split = 0; split < 2; ++split) {
    body = split_at_middles(body);
    out.resize(body.points.size());
    Binding(rest, body, {}).update(posed, out);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((out[i] - before[i]).norm(), 1e-12) << split;
  }
}

}  // namespace
}  // namespace tendril::bind
