#include <gtest/gtest.h>
#include <tendril/base/error.h>

#include <set>

#include "collision/bound_meshes.h"

namespace tendril::collision {
namespace {

using test::bent;
using test::bound_to_three;
using test::BoundMesh;
using test::each;
using test::Random;
using test::random_pose;
using test::with_control_point;
using Node = PlacedCells::Node;
using Pose = std::vector<CurvePair>;

#ifndef TENDRIL_MANY_POSES
#define TENDRIL_MANY_POSES 60
#endif
constexpr int kPoses = TENDRIL_MANY_POSES;

constexpr HierarchyOptions kNeverRefit{256, 2.0};

/// Boxes of all nodes down to the cells, as they are before anything is deformed.
void collect(PlacedCells& cells, const Node& n, std::vector<Box>& boxes) {
  boxes.push_back(cells.box(n));
  if (n.cell()) return;
  collect(cells, n.left(), boxes);
  collect(cells, n.right(), boxes);
}

struct Containment {
  long culls = 0;  ///< corner in a box of its cell or above
  long missed = 0;
  long other = 0;     ///< corners that are not those of the update
  double length = 0;  ///< sums of diagonals: of boxes from slabs, and of exact ones
  double exact = 0;
};

/// Exact boxes of the nodes in the same order, each held against the one before.
Box compare(PlacedCells& cells, const Node& n, const std::vector<Vec3>& at,
            const std::vector<Triangle>& triangles, const std::vector<Box>& boxes, std::size_t& next,
            Containment& sum) {
  const Box& lazy = boxes[next++];
  Box box;
  long corners = 0;
  if (n.cell()) {
    cells.open(n);
    box = cells.box(n);
    const auto visit = [&](const auto& self, const Node& in) -> void {
      if (!in.leaf()) {
        self(self, in.left());
        self(self, in.right());
        return;
      }
      cells.triangles(in, [&](const PlacedTriangle& t) {
        for (std::size_t k = 0; k < 3; ++k) {
          if (t.corners[k] != at[triangles[t.index][k]]) ++sum.other;
          if (!lazy.holds(t.corners[k]) || !box.holds(t.corners[k])) ++sum.missed;
          ++corners;
        }
      });
    };
    visit(visit, n);
    sum.culls += corners;
  } else {
    const Box left = compare(cells, n.left(), at, triangles, boxes, next, sum);
    box = join(left, compare(cells, n.right(), at, triangles, boxes, next, sum));
    if (!lazy.holds(box.low) || !lazy.holds(box.high)) ++sum.missed;
    sum.culls += static_cast<long>(n.size() * PlacedCells::kLeaf * 3);
  }
  sum.length += (lazy.high - lazy.low).norm();
  sum.exact += (box.high - box.low).norm();
  return box;
}

void add(const BoundMesh& mesh, PlacedCells& cells, const Pose& pose, Containment& sum) {
  cells.pose(pose);
  std::vector<Box> boxes;
  collect(cells, cells.root(), boxes);
  std::size_t next = 0;
  compare(cells, cells.root(), mesh.at(pose), mesh.triangles, boxes, next, sum);
}

/// Poses in which frames fail: points on each other, folded back, offsets along the tangent or 0.
std::vector<Pose> degenerate_poses(const Pose& rest, Random& random) {
  std::vector<Pose> out;
  const auto posed = [&](auto change) {
    out.push_back(each(rest, [&](const CurvePair& pair) {
      std::vector<Vec3> u(pair.primary().control_points().begin(), pair.primary().control_points().end());
      std::vector<Vec3> v(pair.orientation().control_points().begin(),
                          pair.orientation().control_points().end());
      for (std::size_t i = 0; i < u.size(); ++i) change(i, u, v);
      return CurvePair(pair.knots(), u, v);
    }));
  };
  posed([](auto i, auto& u, auto& v) { v[i] = u[i]; });
  posed([](auto i, auto& u, auto& v) { v[i] = u[i] + Vec3(0.3, 0, 0); });
  posed([](auto i, auto& u, auto& v) { u[i] = Vec3(1, 2, 3), v[i] = Vec3(1, 2, 3.5); });
  posed([](auto i, auto& u, auto& v) { u[i] = v[i] = Vec3(1, 2, 3); });
  posed([](auto i, auto& u, auto&) { u[i].x() = i % 2 == 0 ? 0.0 : 1.0; });
  posed([](auto i, auto& u, auto&) { u[i] = i > 2 && i < 7 ? u[2] : u[i]; });
  posed([](auto i, auto& u, auto& v) { v[i] = u[i] + (i % 2 == 0 ? 1 : -1) * Vec3(0, 0, 0.1); });
  posed([&](auto i, auto& u, auto& v) { v[i] = u[i] + Vec3(0.3, 0, 0) + random.in_cube(1e-9); });
  posed([](auto i, auto& u, auto& v) { u[i] *= 1e-120, v[i] *= 1e-120; });
  posed([](auto i, auto& u, auto& v) { u[i] *= 1e120, v[i] *= 1e120; });
  posed([](auto i, auto& u, auto& v) { u[i] += Vec3(1e9, -1e9, 1e9), v[i] += Vec3(1e9, -1e9, 1e9); });
  return out;
}

/// Frames turned about the tangents by up to many turns, of the same curves one after another, and not at
/// all again.
std::vector<Pose> turned_poses(const Pose& rest) {
  std::vector<Pose> out;
  for (const double each_control : {1.0, 2.5, 40.0, 0.0}) {
    out.push_back(rest);
    for (CurvePair& pair : out.back()) {
      std::vector<double> turn;
      for (std::size_t i = 0; i < pair.primary().control_points().size(); ++i)
        turn.push_back(each_control * static_cast<double>(i));
      pair.set_turn(each_control > 0.0 ? turn : std::vector<double>{});
    }
  }
  return out;
}

BoundMesh bound_tube() {
  return {{test::straight_pair(8, 0.05)}, test::tube(40, 24, 0.1)};
}
BoundMesh bound_leaf() {
  return {{test::straight_pair(6, 0.0)}, test::leaf(40, 32)};
}

/// A ball in the bow of a U, whose points have places far from each other on one curve-pair.
BoundMesh bound_in_a_bow() {
  bind::BindOptions options;
  options.mode = bind::BindMode::continuous;
  options.band = 1.0;
  std::vector<Vec3> p;
  for (int i = 0; i < 12; ++i) {
    const double a = std::numbers::pi * (i / 11.0);
    p.emplace_back(0.5 + 0.3 * std::cos(a), 0.3 * std::sin(a), 0.0);
  }
  return {{test::pair_through(p, Vec3::UnitZ(), 0.1)}, test::tube(40, 24, 0.2), options};
}

void hold(const BoundMesh& mesh, std::uint64_t seed) {
  PlacedCells cells(mesh.rest, mesh.points, mesh.triangles, kNeverRefit);
  Containment sum;
  Random random(seed);
  for (int i = 0; i < kPoses; ++i) add(mesh, cells, random_pose(mesh.rest, random), sum);
  for (const Pose& pose : degenerate_poses(mesh.rest, random)) add(mesh, cells, pose, sum);
  add(mesh, cells, mesh.rest, sum);
  for (const Pose& pose : turned_poses(mesh.rest)) add(mesh, cells, pose, sum);
  EXPECT_EQ(sum.missed, 0);
  EXPECT_EQ(sum.other, 0);
  EXPECT_GT(sum.culls, 27000L * kPoses);
}

TEST(AxialHierarchy, BoxesHoldATube) {
  hold(bound_tube(), 1);
}
TEST(AxialHierarchy, BoxesHoldALeaf) {
  hold(bound_leaf(), 2);
}

TEST(AxialHierarchy, BoxesHoldPointsOfSeveralCurvePairs) {
  const BoundMesh mesh = bound_to_three();
  ASSERT_GT(mesh.binding.report().shares, mesh.binding.size() + 100);
  hold(mesh, 3);
}

TEST(AxialHierarchy, BoxesHoldPointsWithPlacesFarApart) {
  const BoundMesh mesh = bound_in_a_bow();
  ASSERT_GT(mesh.binding.report().shares, mesh.binding.size() + 100);
  hold(mesh, 4);
}

/// Slab boxes are longer than exact ones by little, and every slab of a sound pose has a frame.
TEST(AxialHierarchy, BoxesAreTight) {
  for (const BoundMesh& mesh : {bound_tube(), bound_leaf()}) {
    PlacedCells cells(mesh.rest, mesh.points, mesh.triangles, kNeverRefit);
    Containment sum;
    for (const double bend : {0.0, 0.5, 1.0}) {
      const Pose pose = each(mesh.rest, [&](const CurvePair& pair) { return bent(pair, bend, bend); });
      add(mesh, cells, pose, sum);
      EXPECT_EQ(cells.work().unframed, 0U);
    }
    EXPECT_LT(sum.length, 1.35 * sum.exact);
  }
}

std::set<std::uint32_t> brute(const BoundMesh& mesh, const std::vector<Vec3>& at,
                              const std::function<bool(const Box&)>& meets) {
  std::set<std::uint32_t> out;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (meets(test::box_of(at, mesh.triangles[i]))) out.insert(static_cast<std::uint32_t>(i));
  return out;
}

/// Queries about the mesh: on it, near it, and far from it.
Vec3 somewhere(const std::vector<Vec3>& at, Random& random) {
  const Vec3 on = at[static_cast<std::size_t>(random.integer(static_cast<int>(at.size())))];
  return on + random.in_cube(std::exp(random.uniform(-6.0, 0.0)));
}

void compare_queries(const BoundMesh& mesh, AxialHierarchy& hierarchy, const Pose& pose, Random& random) {
  const std::vector<Vec3> at = mesh.at(pose);
  for (int i = 0; i < 6; ++i) {
    const Vec3 a = somewhere(at, random), b = somewhere(at, random);
    const Box box{a.cwiseMin(b), a.cwiseMax(b)};
    const double radius = 0.1 * (a - b).norm();
    std::set<std::uint32_t> in_box, in_ball, on_way;
    const auto keep = [](auto& set) { return [&set](const PlacedTriangle& t) { set.insert(t.index); }; };
    hierarchy.meeting(box, keep(in_box));
    hierarchy.near(a, radius, keep(in_ball));
    hierarchy.along(a, b, keep(on_way));
    EXPECT_EQ(in_box, brute(mesh, at, [&](const Box& other) { return box.meets(other); }));
    const auto near = brute(mesh, at, [&](const Box& other) {
      return (other.low - a).cwiseMax(a - other.high).cwiseMax(0.0).norm() <= radius;
    });
    EXPECT_TRUE(std::includes(in_ball.begin(), in_ball.end(), near.begin(), near.end()));
    EXPECT_LE(in_ball.size(), near.size() + 1);
    EXPECT_EQ(on_way, brute(mesh, at, [&](const Box& other) { return segment_meets(other, a, b); }));
  }
}

TEST(AxialHierarchy, FindsWhatBruteForceFinds) {
  Random random(5);
  for (const BoundMesh& mesh : {bound_tube(), bound_leaf(), bound_to_three(), bound_in_a_bow()}) {
    AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles);
    compare_queries(mesh, hierarchy, mesh.rest, random);
    for (int i = 0; i < 8; ++i) {
      const Pose pose = random_pose(mesh.rest, random);
      hierarchy.pose(pose);
      compare_queries(mesh, hierarchy, pose, random);
    }
  }
}

TEST(AxialHierarchy, PairsAreThoseOfBruteForce) {
  const BoundMesh one{{test::straight_pair(8, 0.05)}, test::tube(24, 10, 0.1)};
  const BoundMesh two{{test::straight_pair(6, 0.0)}, test::leaf(20, 10)};
  AxialHierarchy a(one.rest, one.points, one.triangles), b(two.rest, two.points, two.triangles);
  Random random(6);
  std::size_t met = 0;
  for (int i = 0; i < 12; ++i) {
    const Pose first = random_pose(one.rest, random), second = random_pose(two.rest, random);
    a.pose(first);
    b.pose(second);
    std::set<std::pair<std::uint32_t, std::uint32_t>> found, expected;
    a.pairs(b, [&](const PlacedTriangle& t, const PlacedTriangle& s) { found.insert({t.index, s.index}); });
    const std::vector<Vec3> p = one.at(first), q = two.at(second);
    for (std::uint32_t t = 0; t < one.triangles.size(); ++t)
      for (std::uint32_t s = 0; s < two.triangles.size(); ++s)
        if (test::box_of(p, one.triangles[t]).meets(test::box_of(q, two.triangles[s])))
          expected.insert({t, s});
    EXPECT_EQ(found, expected);
    met += expected.size();
  }
  EXPECT_GT(met, 1000U);
}

/// A far query costs a box, a near one a few cells.
TEST(AxialHierarchy, TouchesNothingFarAndLittleNear) {
  const BoundMesh mesh{{test::straight_pair(8, 0.05)}, test::tube(200, 60, 0.1)};
  AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles);
  hierarchy.pose(each(mesh.rest, [](const CurvePair& pair) { return bent(pair, 1.0, 0.5); }));
  const auto ignore = [](const PlacedTriangle&) {};
  hierarchy.near({0, 0, 9}, 1.0, ignore);
  EXPECT_EQ(hierarchy.work().boxes, 1U);
  EXPECT_EQ(hierarchy.work().slabs, 5U);
  EXPECT_EQ(hierarchy.work().touched, 0U);
  hierarchy.near({0, 0, 0}, 0.02, ignore);
  EXPECT_GT(hierarchy.work().touched, 0U);
  EXPECT_LT(hierarchy.work().touched, hierarchy.work().cells / 10);
  EXPECT_EQ(hierarchy.work().placed, hierarchy.work().touched);
  EXPECT_FALSE(hierarchy.work().refitted);
}

/// A control point of a cubic moves four spans: the boxes and points of the others stay.
TEST(AxialHierarchy, KeepsWhatDidNotMove) {
  const BoundMesh mesh{{test::straight_pair(20, 0.05)}, test::tube(100, 24, 0.05)};
  AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles, kNeverRefit);
  Random random(7);
  const auto ignore = [](const PlacedTriangle&) {};
  const Box all{Vec3::Constant(-9), Vec3::Constant(9)};
  Pose pose = mesh.rest;
  hierarchy.meeting(all, ignore);
  const std::size_t cells = hierarchy.work().cells;
  EXPECT_GE(hierarchy.work().slabs, 17U);
  EXPECT_EQ(hierarchy.work().placed, cells);
  for (int i = 0; i < 20; ++i) {
    pose[0] = with_control_point(pose[0], static_cast<std::size_t>(random.integer(20)), random.in_cube(0.01));
    hierarchy.pose(pose);
    compare_queries(mesh, hierarchy, pose, random);
    hierarchy.meeting(all, ignore);
    EXPECT_LE(hierarchy.work().slabs, 4U * (1 + 64 / 17));
    EXPECT_EQ(hierarchy.work().touched, cells);
    EXPECT_LT(hierarchy.work().placed, cells / 2);
    EXPECT_GT(hierarchy.work().placed, 0U);
  }
  hierarchy.pose(pose);
  hierarchy.meeting(all, ignore);
  EXPECT_EQ(hierarchy.work().slabs, 0U);
  EXPECT_EQ(hierarchy.work().placed, 0U);
  EXPECT_EQ(hierarchy.work().boxes, 0U);
}

/// Where a frame is near degenerate, control points of other spans may decide it: nothing there is kept.
TEST(AxialHierarchy, KeepsNothingDegenerateWhenItsCurvePairMoves) {
  const BoundMesh mesh{{test::straight_pair(20, 0.05)}, test::tube(100, 24, 0.05)};
  AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles, kNeverRefit);
  Random random(8);
  Pose pose = mesh.rest;
  // At the origin, where every derivative is exactly 0: the tangent is then that of the whole polygon.
  for (std::size_t i = 3; i < 9; ++i)
    pose[0] = with_control_point(pose[0], i, -pose[0].primary().control_points()[i]);
  for (int i = 0; i < 6; ++i) {
    pose[0] = with_control_point(pose[0], 19, random.in_cube(0.2));
    hierarchy.pose(pose);
    compare_queries(mesh, hierarchy, pose, random);
    const std::vector<Vec3> at = mesh.at(pose);
    hierarchy.meeting({Vec3::Constant(-9), Vec3::Constant(9)}, [&](const PlacedTriangle& t) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(t.corners[k], at[mesh.triangles[t.index][k]]);
    });
  }
}

/// Past its share everything is refitted, so in the next pose from the start, and back once little is
/// touched.
TEST(AxialHierarchy, TurnsToARefitAndBack) {
  const BoundMesh mesh = bound_tube();
  AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles);
  Random random(9);
  const auto ignore = [](const PlacedTriangle&) {};
  const Box all{Vec3::Constant(-9), Vec3::Constant(9)};
  const auto next = [&] {
    const Pose pose = random_pose(mesh.rest, random);
    hierarchy.pose(pose);
    return pose;
  };
  next();
  hierarchy.meeting(all, ignore);
  EXPECT_TRUE(hierarchy.work().refitted);
  EXPECT_GT(hierarchy.work().boxes, 0U);
  compare_queries(mesh, hierarchy, next(), random);
  EXPECT_TRUE(hierarchy.work().refitted);
  EXPECT_EQ(hierarchy.work().boxes, 0U);
  EXPECT_EQ(hierarchy.work().placed, hierarchy.work().cells);
  next();
  hierarchy.near({50, 0, 0}, 1.0, ignore);
  next();
  hierarchy.near({50, 0, 0}, 1.0, ignore);
  EXPECT_FALSE(hierarchy.work().refitted);
  EXPECT_EQ(hierarchy.work().placed, 0U);
}

TEST(AxialHierarchy, WorksWithOneTriangleAndWithDegenerateOnes) {
  const BoundMesh mesh = bound_leaf();
  const std::vector<Triangle> few{{0, 1, 2}, {5, 5, 5}, {7, 7, 9}};
  for (std::size_t count = 1; count <= few.size(); ++count) {
    AxialHierarchy hierarchy(mesh.rest, mesh.points, std::span(few).first(count));
    std::set<std::uint32_t> found;
    hierarchy.meeting({Vec3::Constant(-9), Vec3::Constant(9)}, [&](const auto& t) { found.insert(t.index); });
    EXPECT_EQ(found.size(), count);
  }
}

TEST(AxialHierarchy, RefusesBadInput) {
  const BoundMesh mesh = bound_leaf();
  const std::vector<Triangle> none, beyond{{0, 1, static_cast<std::uint32_t>(mesh.binding.size())}};
  EXPECT_THROW(AxialHierarchy(mesh.rest, mesh.points, none), InvalidInput);
  EXPECT_THROW(AxialHierarchy(mesh.rest, mesh.points, beyond), InvalidInput);
  EXPECT_THROW(AxialHierarchy(mesh.rest, mesh.points, mesh.triangles, {0, 0.25}), InvalidInput);
  EXPECT_THROW(AxialHierarchy(mesh.rest, mesh.points, mesh.triangles, {256, 0.0}), InvalidInput);
  EXPECT_THROW(AxialHierarchy({}, mesh.points, mesh.triangles), InvalidInput);
  AxialHierarchy hierarchy(mesh.rest, mesh.points, mesh.triangles);
  EXPECT_THROW(hierarchy.pose({}), InvalidInput);
  EXPECT_THROW(hierarchy.pose(std::vector<CurvePair>{test::straight_pair(7, 0.0)}), InvalidInput);
}

}  // namespace
}  // namespace tendril::collision
