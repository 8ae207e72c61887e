#pragma once

#include <tendril/bind/binding_points.h>
#include <tendril/contact/surface_contact.h>
#include <tendril/curve/frames.h>

#include <cmath>

#include "shown.h"
#include "support/rods.h"

namespace tendril::test {

/// A pointed leaf about a straight rod along x, flat in z = 0: `across` squares on either side.
struct Leaf {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline Leaf leaf(double length, double half_width, std::uint32_t along, std::uint32_t across) {
  Leaf out;
  const std::uint32_t row = 2 * across + 1;
  for (std::uint32_t i = 0; i <= along; ++i)
    for (std::uint32_t j = 0; j < row; ++j) {
      const double s = double(i) / along, side = double(j) / across - 1.0;
      out.points.emplace_back(s * length, half_width * std::sqrt(0.02 + s * (1 - s)) * 2 * side, 0.0);
    }
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = i * row + j, b = a + row;
      out.triangles.push_back({a, b, b + 1});
      out.triangles.push_back({a, b + 1, a + 1});
    }
  return out;
}

inline bind::PolygonMesh mesh_of(const Leaf& leaf) {
  bind::PolygonMesh mesh;
  mesh.points = leaf.points;
  for (const auto& t : leaf.triangles) {
    mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  }
  return mesh;
}

/// A leaf's surface on rods, bound to all of them where it is nearest, and blended where that jumps.
inline contact::ContactSurface surface_on(const std::vector<Rod>& rods, const Leaf& leaf, double skin) {
  RodCurves curves(rods);
  std::vector<CurvePair> rest;
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    rest.push_back(curves.through(r, rods[r].p, rods[r].q));
    all.push_back(r);
  }
  bind::Binding binding(rest, mesh_of(leaf), {.mode = bind::BindMode::continuous});
  auto points = std::make_shared<RodPoints>(std::move(curves), std::move(all),
                                            std::make_shared<bind::BindingPoints>(std::move(binding)));
  return {std::move(points), leaf.points, leaf.triangles, skin};
}

/// Two rods side by side, so that the leaf between them is blended.
inline std::vector<Rod> stalks() {
  std::vector<Rod> rods;
  for (const double y : {-0.08, 0.08}) {
    std::vector<Vec3> p;
    for (int i = 0; i <= 8; ++i) p.emplace_back(0.125 * i, y + 0.02 * std::sin(2.0 * i), 0.01 * std::cos(i));
    rods.push_back(
        make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), {1e6, 4e5, 500.0}, circular_section(0.02)));
  }
  return rods;
}

/// The rods moved and turned anyhow, and moving.
inline Shown shown_of(const std::vector<Rod>& rods, Random& random, double by, double speed) {
  Shown s;
  for (const Rod& rod : rods) {
    std::vector<Vec3> p = rod.p;
    for (Vec3& x : p) x += random.in_cube(by);
    std::vector<Vec3> q = p;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += rod.q[i] - rod.p[i] + random.in_cube(by);
    const NodeFrames frames = node_frames(p, q);
    s.rods.push_back({s.p.size(), p.size()});
    for (std::size_t i = 0; i < p.size(); ++i) {
      s.p.push_back(p[i]);
      s.v.push_back(random.in_cube(speed));
      s.turn.push_back(random.in_cube(speed));
      s.t.push_back(frames.frame[i].z);
      s.m.push_back(frames.frame[i].y);
      s.spin.push_back(s.turn.back().dot(s.t.back()));
      s.mass.push_back(1.0);
      s.width.push_back(0.1);
    }
  }
  return s;
}

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

inline Mat3 about_z(double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
}

/// Two leaves, one across the other and so far above it.
inline Sheets crossed(double height, double angle = 1.3) {
  Sheets sheets;
  const Rod rod = straight_rod(8, 1e6, 0.01, 400.0);
  sheets.add(leaf(1.0, 0.15, 14, 3), rod, Vec3::Zero());
  sheets.add(leaf(1.0, 0.15, 14, 3), rod, Vec3(0.4, -0.4 * angle, height), about_z(angle));
  return sheets;
}

}  // namespace tendril::test
