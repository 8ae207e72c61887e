#pragma once

#include "leaf.h"

namespace tendril::test {

/// A leaf or several, each about a rod of its own, in one mesh.
struct Sheets {
  std::vector<Rod> rods;
  Leaf mesh;

  /// Adds a leaf about a straight rod: moved and turned as said.
  void add(const Leaf& leaf, const Rod& rod, const Vec3& by, const Mat3& turned = Mat3::Identity()) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const Vec3& x : leaf.points) mesh.points.push_back(turned * x + by);
    for (const auto& [a, b, c] : leaf.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    rods.push_back(rod);
    for (Vec3& x : rods.back().p) x = turned * x + by;
    for (Vec3& x : rods.back().q) x = turned * x + by;
  }
  contact::ContactSurface surface(double skin) const { return surface_on(rods, mesh, skin); }
};

}  // namespace tendril::test
