#include <gtest/gtest.h>
#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>

#include <memory>

#include "axis/shapes.h"

namespace tendril::test {
namespace {

/// Largest distance, by `field`, of the curve from where that vanishes.
double farthest(const axis::AxisCurve& curve, const Field& field) {
  const CurvePair pair = axis::pair_of(curve);
  double largest = 0.0;
  for (int k = 0; k <= 400; ++k) largest = std::max(largest, field(pair.primary().value(k / 400.0)));
  return largest;
}

void expect_frames_that_do_not_turn(const axis::AxisCurve& curve) {
  const CurvePair pair = axis::pair_of(curve);
  for (int k = 0; k <= 400; ++k) {
    const CurveFrame at = pair.frame(k / 400.0);
    EXPECT_EQ(at.status, FrameStatus::ok);
    EXPECT_GT(at.sine, 0.9);
  }
}

TEST(Axis, OfACapsuleIsItsSegment) {
  const axis::AxisTree tree = axis::find_axis(capsule());
  ASSERT_EQ(tree.status, axis::AxisStatus::found);
  ASSERT_EQ(tree.curves.size(), 1U);
  EXPECT_EQ(tree.report.loops, 0U);
  const axis::AxisCurve& curve = tree.curves[0];
  const Field line = [](const Vec3& p) { return capsule_field(p, -Vec3::UnitX(), Vec3::UnitX(), 0.0); };
  EXPECT_LT(farthest(curve, line), 0.03 * 0.2);
  EXPECT_NEAR(curve.length, 2.0, 0.08);
  EXPECT_EQ(curve.outside, 0U);
  EXPECT_FALSE(curve.joint.has_value());
  for (const double r : curve.radius) EXPECT_NEAR(r, 0.2, 0.01);
  expect_frames_that_do_not_turn(curve);
}

TEST(Axis, OfATorusIsOneLoopCutOpen) {
  const axis::AxisTree tree = axis::find_axis(torus());
  ASSERT_EQ(tree.curves.size(), 1U);
  EXPECT_EQ(tree.report.loops, 1U);
  ASSERT_EQ(tree.report.cuts.size(), 1U);
  const axis::AxisCurve& curve = tree.curves[0];
  EXPECT_EQ(curve.points.front(), curve.points.back());
  EXPECT_EQ(curve.points.front(), tree.report.cuts[0]);
  EXPECT_LT(farthest(curve, [](const Vec3& p) { return torus_field(p, 1.0, 0.0); }), 0.1 * 0.25);
  EXPECT_NEAR(curve.length, 2.0 * 3.14159265358979, 0.05);
  expect_frames_that_do_not_turn(curve);
}

/// A ring on a stick: the ring is cut where it is farthest from the junction, and both halves stay on.
TEST(Axis, OfARingOnAStickIsCutAcross) {
  const Vec3 foot = Vec3::UnitX(), tip = 2.2 * Vec3::UnitX();
  const auto field = [&](double r) {
    return [=](const Vec3& p) { return std::min(torus_field(p, 1.0, r), capsule_field(p, foot, tip, r)); };
  };
  const axis::AxisTree tree =
      axis::find_axis(Isosurface(field(0.2), Vec3(-1.31, -1.32, -0.33), Vec3(2.5, 1.3, 0.3), 0.0701).mesh());
  EXPECT_EQ(tree.report.loops, 1U);
  ASSERT_EQ(tree.report.cuts.size(), 1U);
  EXPECT_LT(tree.report.cuts[0].x(), -0.8);
  ASSERT_EQ(tree.curves.size(), 2U);
  for (const axis::AxisCurve& curve : tree.curves) EXPECT_LT(farthest(curve, field(0.0)), 0.4 * 0.2);
}

TEST(Axis, OfThreeTubesHasThreeEndsAndAJunction) {
  const axis::AxisTree tree = axis::find_axis(three_tubes());
  ASSERT_EQ(tree.curves.size(), 2U);
  EXPECT_EQ(tree.report.loops, 0U);
  const Field arms_field = [](const Vec3& p) {
    double least = 1e9;
    for (const Vec3& arm : arms()) least = std::min(least, capsule_field(p, Vec3::Zero(), arm, 0.0));
    return least;
  };
  for (const axis::AxisCurve& curve : tree.curves) {
    EXPECT_LT(farthest(curve, arms_field), 0.4 * 0.15);
    EXPECT_EQ(curve.outside, 0U);
    EXPECT_LE(curve.strays, 0.3);
    expect_frames_that_do_not_turn(curve);
  }
  const axis::AxisCurve& child = tree.curves[1];
  ASSERT_TRUE(child.joint.has_value());
  EXPECT_EQ(child.joint->parent, 0U);
  EXPECT_EQ(child.points.front(), tree.curves[0].points[child.joint->node]);
  EXPECT_LT(child.points.front().norm(), 0.5 * 0.15);
  // Each arm's tip is an end of a curve: nearer to it than the tubes are thick.
  for (const Vec3& arm : arms()) {
    double least = 1e9;
    for (const axis::AxisCurve& curve : tree.curves)
      least = std::min({least, (curve.points.front() - arm).norm(), (curve.points.back() - arm).norm()});
    EXPECT_LT(least, 0.5 * 0.15);
  }
}

TEST(Axis, PrunesWhatReachesLessFarThanAsked) {
  const bind::PolygonMesh mesh = three_tubes();
  axis::AxisOptions options;
  options.prune = 20.0;  // the arms reach about 9 radii
  const axis::AxisTree bare = axis::find_axis(mesh, options);
  EXPECT_EQ(bare.curves.size(), 1U);
  ASSERT_FALSE(bare.report.twigs.empty());
  EXPECT_GT(bare.report.twigs.back().reach, 5.0);
  EXPECT_GT(bare.report.twigs.back().length, 0.8);
  options.prune = 0.0;
  const axis::AxisTree full = axis::find_axis(mesh, options);
  EXPECT_TRUE(full.report.twigs.empty());
  EXPECT_GE(full.curves.size(), 2U);
}

/// A trunk on legs, one of them a little shorter than the one beside it.
bind::PolygonMesh with_legs(double shorter) {
  const Field field = [=](const Vec3& p) {
    double least = capsule_field(p, Vec3(-1, 0, 0), Vec3(1, 0, 0), 0.25);
    for (const double side : {-1.0, 1.0})
      least = std::min(least, capsule_field(p, Vec3(0.2, 0, 0.3 * side),
                                            Vec3(0.2, side < 0 ? -0.7 : -0.7 + shorter, 0.3 * side), 0.1));
    return least;
  };
  return Isosurface(field, Vec3(-1.31, -0.82, -0.43), Vec3(1.3, 0.3, 0.45), 0.0501).mesh();
}

/// They reach about four times as far as the trunk is wide where they branch off, the one a few per cent
/// farther than the other.
TEST(Axis, KeepsBothOrNoneOfTwoLegsThatAreNearlyMirrorImages) {
  const bind::PolygonMesh mesh = with_legs(0.02);
  axis::AxisOptions options;
  options.prune = 10.0;
  const std::vector<axis::Twig> legs = axis::find_axis(mesh, options).report.twigs;
  ASSERT_EQ(legs.size(), 2U);
  const double near = std::min(legs[0].reach, legs[1].reach), far = std::max(legs[0].reach, legs[1].reach);
  ASSERT_GT(far, 1.01 * near);
  ASSERT_LT(far, 1.1 * near);
  std::vector<std::size_t> curves;
  for (const double prune : {0.8 * near, 0.5 * (near + far), 1.1 * far}) {
    options.prune = prune;
    curves.push_back(axis::find_axis(mesh, options).curves.size());
  }
  EXPECT_EQ(curves, (std::vector<std::size_t>{3, 3, 1}));
}

TEST(Axis, SaysWhatSkinHasNoCurveNear) {
  axis::AxisOptions options;
  EXPECT_GT(axis::find_axis(three_tubes()).report.coverage, 0.99);
  options.prune = 20.0;
  const axis::AxisTree bare = axis::find_axis(three_tubes(), options);
  EXPECT_EQ(bare.status, axis::AxisStatus::uncovered);
  EXPECT_NEAR(bare.report.coverage, 0.79, 0.01);  // the third tube has none, three radii of it aside
  const Vec3 missed = bare.report.twigs.back().tip;
  EXPECT_LT((bare.report.farthest - missed).norm(), 0.2);
  EXPECT_FALSE(bare.reason.empty());
  EXPECT_EQ(bare.curves.size(), 1U);
}

TEST(Axis, GrowsAndMovesWithTheMesh) {
  const bind::PolygonMesh mesh = capsule();
  const axis::AxisCurve here = axis::find_axis(mesh).curves[0];
  bind::PolygonMesh changed = mesh;
  for (Vec3& p : changed.points) p *= 1024.0;
  const axis::AxisCurve grown = axis::find_axis(changed).curves[0];
  ASSERT_EQ(grown.points.size(), here.points.size());
  for (std::size_t k = 0; k < here.points.size(); ++k) {
    EXPECT_EQ(grown.points[k], 1024.0 * here.points[k]);
    EXPECT_EQ(grown.orientation[k], 1024.0 * here.orientation[k]);
    EXPECT_EQ(grown.radius[k], 1024.0 * here.radius[k]);
  }
  // What the contraction collapses would feel the last bit.
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    changed.points[i] = 0.3048 * mesh.points[i] + Vec3(40, 0.3, -8);
  const axis::AxisCurve moved = axis::find_axis(changed).curves[0];
  EXPECT_NEAR(moved.length, 0.3048 * here.length, 1e-12);
  ASSERT_EQ(moved.points.size(), here.points.size());
  for (std::size_t k = 0; k < here.points.size(); ++k)
    EXPECT_LT((moved.points[k] - 0.3048 * here.points[k] - Vec3(40, 0.3, -8)).norm(), 1e-12);
}

/// Leaves the heap so that what is allocated next comes to lie in no order.
void scramble_the_heap() {
  std::vector<std::unique_ptr<char[]>> blocks;
  for (std::size_t k = 0; k < 200000; ++k)
    blocks.push_back(std::make_unique<char[]>(16 + 16 * (k * 7919 % 40)));
  for (std::size_t k = 0; k < blocks.size(); ++k) std::swap(blocks[k], blocks[k * 104729 % blocks.size()]);
  for (std::size_t k = 0; k < blocks.size(); k += 2) blocks[k].reset();
}

TEST(Axis, GivesTheSameBitsWhateverTheHeapIsLike) {
  const bind::PolygonMesh mesh = three_tubes();
  const axis::AxisTree one = axis::find_axis(mesh);
  scramble_the_heap();
  const axis::AxisTree two = axis::find_axis(mesh);
  ASSERT_EQ(one.curves.size(), two.curves.size());
  for (std::size_t k = 0; k < one.curves.size(); ++k) {
    EXPECT_EQ(one.curves[k].points, two.curves[k].points);
    EXPECT_EQ(one.curves[k].orientation, two.curves[k].orientation);
    EXPECT_EQ(one.curves[k].radius, two.curves[k].radius);
  }
}

TEST(Axis, SpacingIsAsAsked) {
  axis::AxisOptions options;
  options.spacing = 0.25;
  const axis::AxisTree tree = axis::find_axis(capsule(), options);
  EXPECT_EQ(tree.curves[0].points.size(), 9U);
  options.spacing = 1e-9;
  EXPECT_THROW(axis::find_axis(capsule(), options), InvalidInput);
}

TEST(Axis, PolygonsBecomeFans) {
  bind::PolygonMesh mesh;  // a box of six quads, four times as long as it is wide
  for (int k = 0; k < 8; ++k)
    mesh.points.emplace_back(k & 1 ? 4.0 : 0.0, k & 2 ? 1.0 : 0.0, k & 4 ? 1.0 : 0.0);
  mesh.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
  for (std::uint32_t f = 1; f <= 6; ++f) mesh.face_begin.push_back(4 * f);
  const axis::AxisTree tree = axis::find_axis(mesh);
  ASSERT_EQ(tree.curves.size(), 1U);
  for (const Vec3& p : tree.curves[0].points) EXPECT_LT((p - Vec3(p.x(), 0.5, 0.5)).norm(), 0.1);
}

}  // namespace
}  // namespace tendril::test
