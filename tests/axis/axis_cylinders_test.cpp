// Cylinders with flat lids, thick and thin, of meshes that are coarse or fine in either direction.

#include <gtest/gtest.h>
#include <tendril/axis/find_axis.h>

#include <chrono>
#include <cstdio>

#include "axis/shapes.h"

namespace tendril::test {
namespace {

constexpr double kLength = 10.0;

struct Found {
  double reach = 0.0;  ///< along the cylinder, in its length less a radius at either lid
  double off = 0.0;    ///< of its nodes from the cylinder's axis, the farthest, in radii
};

Found find(const bind::PolygonMesh& mesh, double radius) {
  const axis::AxisTree tree = axis::find_axis(mesh, {});
  EXPECT_EQ(tree.status, axis::AxisStatus::found) << tree.reason;
  EXPECT_EQ(tree.curves.size(), 1U);
  double low = kLength, high = 0.0;
  Found found;
  for (const Vec3& p : tree.curves.at(0).points) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
    found.off = std::max(found.off, p.head<2>().norm() / radius);
  }
  found.reach = (high - low) / (kLength - 2.0 * radius);
  return found;
}

bind::PolygonMesh inside_out(bind::PolygonMesh mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    std::reverse(mesh.corners.begin() + mesh.face_begin[f], mesh.corners.begin() + mesh.face_begin[f + 1]);
  return mesh;
}

struct Meshed {
  double slenderness;  ///< length in radii
  std::uint32_t rings, round;
};
constexpr Meshed kCylinders[]{{5, 40, 60},   {5, 10, 300},    {20, 400, 24}, {20, 100, 200},
                              {50, 50, 12},  {50, 400, 100},  {100, 100, 8}, {100, 500, 32},
                              {200, 200, 8}, {200, 1000, 24}, {200, 400, 64}};

TEST(AxisOfCylinders, IsTheirAxisOverItsLength) {
  std::printf("%6s %6s %6s %11s %8s %8s %8s\n", "L / r", "rings", "round", "", "reach", "off / r", "seconds");
  for (const Meshed& meshed : kCylinders) {
    const double radius = kLength / meshed.slenderness;
    const bind::PolygonMesh mesh = cylinder(kLength, radius, meshed.rings, meshed.round);
    for (const bool turned : {false, true}) {
      const auto start = std::chrono::steady_clock::now();
      const Found found = find(turned ? inside_out(mesh) : mesh, radius);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      std::printf("%6.0f %6u %6u %11s %8.3f %8.3f %8.2f\n", meshed.slenderness, meshed.rings, meshed.round,
                  turned ? "inside out" : "", found.reach, found.off, seconds);
      EXPECT_GE(found.reach, 0.95);
      EXPECT_LE(found.off, 0.05);
    }
  }
}

}  // namespace
}  // namespace tendril::test
