#include <gtest/gtest.h>
#include <tendril/axis/find_axis.h>
#include <tendril/base/error.h>
#include <tendril/bind/inspect.h>

#include <limits>

#include "axis/shapes.h"

namespace tendril::test {
namespace {

/// A coarse sphere, which no test of this file contracts unless it says so.
bind::PolygonMesh ball(const Vec3& centre, double radius) {
  const Field field = [&](const Vec3& p) { return (p - centre).norm() - radius; };
  const Vec3 room = 1.2 * radius * Vec3(1.01, 1.0, 1.02);
  return Isosurface(field, centre - room, centre + room, 0.3 * radius).mesh();
}

void append(bind::PolygonMesh& mesh, const bind::PolygonMesh& other) {
  const auto shift = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (std::size_t f = 0; f < other.face_count(); ++f) {
    for (const std::uint32_t i : other.face(f)) mesh.corners.push_back(i + shift);
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
}

/// Without the faces that have a corner where `gone` holds.
bind::PolygonMesh without(const bind::PolygonMesh& mesh, const std::function<bool(const Vec3&)>& gone) {
  bind::PolygonMesh out;
  out.points = mesh.points;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    if (std::any_of(face.begin(), face.end(), [&](std::uint32_t i) { return gone(mesh.points[i]); }))
      continue;
    out.corners.insert(out.corners.end(), face.begin(), face.end());
    out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
  }
  return out;
}

axis::AxisOptions with(double axis::AxisOptions::*which, double value) {
  axis::AxisOptions options;
  options.*which = value;
  return options;
}

axis::AxisOptions with(bool axis::AxisOptions::*which) {
  axis::AxisOptions options;
  options.*which = true;
  return options;
}

std::string refusal(const bind::PolygonMesh& mesh, const axis::AxisOptions& options = {}) {
  try {
    axis::find_axis(mesh, options);
  } catch (const InvalidInput& error) {
    return error.place() + ": " + error.reason();
  }
  return "accepted";
}

TEST(AxisRefusal, NamesAllThatIsWrongWithCounts) {
  bind::PolygonMesh mesh = without(ball(Vec3::Zero(), 1.0), [](const Vec3& p) { return p.z() > 0.9; });
  append(mesh, ball(Vec3(5, 0, 0), 1.0));
  EXPECT_EQ(refusal(mesh), "mesh: 2 parts, 1 hole(s)");
  EXPECT_EQ(refusal(bind::PolygonMesh{}), "mesh: no faces");
}

TEST(AxisRefusal, NonManifoldFlippedAndDegenerate) {
  bind::PolygonMesh flipped = ball(Vec3::Zero(), 1.0);
  std::swap(flipped.corners[0], flipped.corners[1]);
  EXPECT_EQ(refusal(flipped), "mesh: 3 edge(s) used twice in one direction");
  bind::PolygonMesh fin = ball(Vec3::Zero(), 1.0);
  fin.points.emplace_back(0, 0, 3);
  fin.corners.insert(fin.corners.end(),
                     {fin.corners[0], fin.corners[1], static_cast<std::uint32_t>(fin.points.size() - 1)});
  fin.face_begin.push_back(static_cast<std::uint32_t>(fin.corners.size()));
  EXPECT_NE(refusal(fin).find("1 non-manifold edge(s)"), std::string::npos) << refusal(fin);
  bind::PolygonMesh flat = ball(Vec3::Zero(), 1.0);
  flat.points[flat.corners[0]] = flat.points[flat.corners[1]];
  EXPECT_NE(refusal(flat).find("triangle(s) of no area"), std::string::npos) << refusal(flat);
}

TEST(AxisRefusal, NotFiniteAndOutOfRange) {
  bind::PolygonMesh mesh = ball(Vec3::Zero(), 1.0);
  mesh.points[7].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(mesh), "accepted");
  mesh.points[7].y() = 1e200;
  EXPECT_EQ(refusal(mesh), "points[7]: beyond 1e100");
  const bind::PolygonMesh good = ball(Vec3::Zero(), 1.0);
  EXPECT_EQ(refusal(good, with(&axis::AxisOptions::prune, -1.0)).substr(0, 6), "prune:");
  axis::AxisOptions no_spacing;
  no_spacing.spacing = 0.0;
  EXPECT_EQ(refusal(good, no_spacing).substr(0, 8), "spacing:");
  EXPECT_EQ(refusal(good, with(&axis::AxisOptions::tolerance, 2.0)).substr(0, 10), "tolerance:");
  EXPECT_EQ(refusal(good, with(&axis::AxisOptions::time_limit, std::nan(""))).substr(0, 11), "time_limit:");
}

/// One point far off: what it makes of the others would be split into ever more pieces.
TEST(AxisRefusal, NeedlesBeyondAllMeasure) {
  for (const double far : {1e6, 1e7}) {
    bind::PolygonMesh mesh = cylinder(1.0, 0.1, 7, 5);
    mesh.points[17] = Vec3(far, 0, 0);
    EXPECT_EQ(refusal(mesh), "mesh: triangles thousands of times as long as the surface is wide") << far;
  }
}

TEST(AxisRefusal, TheTimeLimitIsAStatus) {
  axis::AxisOptions options;
  options.time_limit = 1e-3;
  const axis::AxisTree tree = axis::find_axis(capsule(), options);
  EXPECT_EQ(tree.status, axis::AxisStatus::time_limit);
  EXPECT_TRUE(tree.curves.empty());
  EXPECT_NE(tree.reason.find("time limit"), std::string::npos);
}

TEST(AxisRefusal, HolesAreClosedInACopyWhenAsked) {
  const bind::PolygonMesh open = without(capsule(), [](const Vec3& p) { return std::abs(p.x()) > 1.1; });
  EXPECT_EQ(bind::inspect(open).boundary_loops, 2U);
  EXPECT_EQ(refusal(open), "mesh: 2 hole(s)");
  const axis::AxisTree tree = axis::find_axis(open, with(&axis::AxisOptions::close));
  EXPECT_EQ(tree.report.closed_holes, 2U);
  ASSERT_EQ(tree.curves.size(), 1U);
  for (const Vec3& p : tree.curves[0].points) EXPECT_LT(std::hypot(p.y(), p.z()), 0.05 * 0.2);
}

TEST(AxisRefusal, HolesThatTouchAreSplit) {
  const bind::PolygonMesh whole = capsule();
  // Without every second face around a point.
  std::uint32_t centre = 0;
  for (std::uint32_t i = 0; i < whole.points.size(); ++i)
    if ((whole.points[i] - Vec3(0, 0, 0.2)).norm() < (whole.points[centre] - Vec3(0, 0, 0.2)).norm())
      centre = i;
  bind::PolygonMesh open;
  open.points = whole.points;
  std::vector<std::uint32_t> touched;  // points of the faces left out, other than the centre
  for (std::size_t f = 0; f < whole.face_count(); ++f) {
    const auto face = whole.face(f);
    const bool at = std::find(face.begin(), face.end(), centre) != face.end();
    const bool shares = std::any_of(face.begin(), face.end(), [&](std::uint32_t i) {
      return std::find(touched.begin(), touched.end(), i) != touched.end();
    });
    if (at && !shares && touched.size() < 4) {
      for (const std::uint32_t i : face)
        if (i != centre) touched.push_back(i);
      continue;
    }
    open.corners.insert(open.corners.end(), face.begin(), face.end());
    open.face_begin.push_back(static_cast<std::uint32_t>(open.corners.size()));
  }
  ASSERT_EQ(bind::inspect(open).non_manifold_points.size(), 1U);
  const axis::AxisTree tree = axis::find_axis(open, with(&axis::AxisOptions::close));
  EXPECT_EQ(tree.report.split_points, 1U);
  EXPECT_EQ(tree.report.closed_holes, 1U);  // the two are one when the point between them is split
  EXPECT_EQ(tree.curves.size(), 1U);
}

TEST(AxisRefusal, TheLargestPartIsTakenWhenAsked) {
  bind::PolygonMesh mesh = ball(Vec3(0, 3, 0), 0.3);
  append(mesh, capsule());
  EXPECT_EQ(refusal(mesh), "mesh: 2 parts");
  const axis::AxisTree tree = axis::find_axis(mesh, with(&axis::AxisOptions::largest_part));
  EXPECT_EQ(tree.report.left_out_parts, 1U);
  ASSERT_EQ(tree.curves.size(), 1U);
  EXPECT_NEAR(tree.curves[0].length, 2.0, 0.05);
}

}  // namespace
}  // namespace tendril::test
