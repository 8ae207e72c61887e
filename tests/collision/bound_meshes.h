#pragma once

#include <tendril/bind/binding_points.h>
#include <tendril/collision/axial_hierarchy.h>
#include <tendril/curve/fit.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <unordered_map>

#include "support/pairs.h"
#include "support/random.h"

/// Meshes bound to curve-pairs, and poses for them.
namespace tendril::test {

using collision::Triangle;

/// A closed tube along x from 0 to 1: `rings` + 1 sections of `around` points, and a point in the middle of
/// either end.
/// \param section  (y, z) of the point at an angle and a place along x
inline bind::PolygonMesh closed_tube(int rings, int around,
                                     const std::function<Eigen::Vector2d(double angle, double x)>& section) {
  bind::PolygonMesh mesh;
  const auto add = [&](int a, int b, int c) {
    for (const int corner : {a, b, c}) mesh.corners.push_back(static_cast<std::uint32_t>(corner));
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  };
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double x = static_cast<double>(i) / rings;
      const Eigen::Vector2d at = section(2 * std::numbers::pi * j / around, x);
      mesh.points.emplace_back(x, at.x(), at.y());
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      add(a, b + around, b);
      add(a, a + around, b + around);
    }
  const int begin = static_cast<int>(mesh.points.size()), last = rings * around;
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(1, 0, 0);
  for (int j = 0; j < around; ++j) {
    add(begin, j, (j + 1) % around);
    add(begin + 1, last + (j + 1) % around, last + j);
  }
  return mesh;
}

/// 1 long, 0.4 wide (z), 0.012 thick (y).
inline bind::PolygonMesh leaf(int rings, int around) {
  return closed_tube(rings, around, [](double angle, double) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double reach = std::max(std::abs(c), std::abs(s));
    return Eigen::Vector2d(0.006 * c / reach, 0.2 * s / reach);
  });
}

inline bind::PolygonMesh tube(int rings, int around, double radius) {
  return closed_tube(rings, around, [radius](double angle, double x) {
    const double r = radius * (1.0 + 0.3 * std::sin(9 * x));
    return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
  });
}

/// Triangles of a mesh whose faces are fanned where they have more corners.
inline std::vector<Triangle> triangles_of(const bind::PolygonMesh& mesh) {
  std::vector<Triangle> out;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 2; i < face.size(); ++i) out.push_back({face[0], face[i - 1], face[i]});
  }
  return out;
}

/// Every triangle into four, through the middles of its edges.
inline bind::PolygonMesh subdivided(const bind::PolygonMesh& mesh) {
  bind::PolygonMesh out;
  out.points = mesh.points;
  std::unordered_map<std::uint64_t, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    const auto [at, fresh] = middles.emplace(key, static_cast<std::uint32_t>(out.points.size()));
    if (fresh) out.points.emplace_back(0.5 * (mesh.points[a] + mesh.points[b]));
    return at->second;
  };
  for (const auto& [a, b, c] : triangles_of(mesh)) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      out.corners.insert(out.corners.end(), t.begin(), t.end());
      out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
    }
  }
  return out;
}

/// The mesh turned and scaled so that its longest side goes along x from 0 to 1, the others about 0.
inline bind::PolygonMesh along_x(bind::PolygonMesh mesh) {
  const collision::Box box = collision::box_of(mesh.points);
  Eigen::Index along = 0;
  const double length = (box.high - box.low).maxCoeff(&along);
  for (Vec3& p : mesh.points) {
    const Vec3 q = (p - 0.5 * (box.low + box.high)) / length;
    p = Vec3(q[along] + 0.5, q[(along + 1) % 3], q[(along + 2) % 3]);
  }
  return mesh;
}

/// The curve-pair bent in the x-y plane by `bend` over its length, turned by `twist` about itself, the
/// distances between control points kept.
inline CurvePair bent(const CurvePair& rest, double bend, double twist) {
  const Points u = rest.primary().control_points(), v = rest.orientation().control_points();
  double total = 0.0;
  for (std::size_t i = 1; i < u.size(); ++i) total += (u[i] - u[i - 1]).norm();
  std::vector<Vec3> c, d;
  double along = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (i > 0) {
      const double step = (u[i] - u[i - 1]).norm();
      const Vec3 way = rotate_about(Vec3::UnitZ(), bend * (along + 0.5 * step) / total, u[i] - u[i - 1]);
      c.push_back(c.back() + way);
      along += step;
    } else {
      c.push_back(u[0]);
    }
    const Vec3 axis = rotate_about(Vec3::UnitZ(), bend * along / total, Vec3::UnitX());
    const Vec3 side = rotate_about(Vec3::UnitZ(), bend * along / total, v[i] - u[i]);
    d.push_back(c.back() + rotate_about(axis, twist * along / total, side));
  }
  return CurvePair(rest.knots(), c, d);
}

/// Control points moved by up to `size` each way.
inline CurvePair shaken(const CurvePair& pair, double size, Random& random) {
  std::vector<Vec3> c(pair.primary().control_points().begin(), pair.primary().control_points().end());
  std::vector<Vec3> d(pair.orientation().control_points().begin(), pair.orientation().control_points().end());
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Vec3 move = random.in_cube(size);
    c[i] += move;
    d[i] += move + random.in_cube(size);
  }
  return CurvePair(pair.knots(), c, d);
}

/// The same with a control point of either curve moved.
inline CurvePair with_control_point(const CurvePair& pair, std::size_t i, const Vec3& move) {
  std::vector<Vec3> u(pair.primary().control_points().begin(), pair.primary().control_points().end());
  std::vector<Vec3> v(pair.orientation().control_points().begin(), pair.orientation().control_points().end());
  u[i] += move;
  v[i] += move;
  return CurvePair(pair.knots(), u, v);
}

/// A mesh with its binding, and what a hierarchy is made from.
struct BoundMesh {
  std::vector<CurvePair> rest;
  bind::Binding binding;
  bind::BindingPoints points;
  std::vector<Triangle> triangles;

  BoundMesh(std::vector<CurvePair> pairs, const bind::PolygonMesh& mesh,
            const bind::BindOptions& options = {})
      : rest(std::move(pairs)),
        binding(rest, mesh, options),
        points(binding),
        triangles(triangles_of(mesh)) {}

  std::vector<Vec3> at(const std::vector<CurvePair>& posed) const {
    std::vector<Vec3> out(binding.size());
    binding.update(posed, out);
    return out;
  }
};

/// A curve-pair along x with this many masses, its ends `inset` from those of [0, 1].
inline CurvePair straight_pair(int masses, double inset) {
  std::vector<Vec3> p;
  for (int i = 0; i < masses; ++i) p.emplace_back(inset + (1.0 - 2.0 * inset) * i / (masses - 1.0), 0.0, 0.0);
  return pair_through(p, Vec3::UnitZ(), 0.1);
}

using Pose = std::vector<CurvePair>;

inline Pose each(const Pose& rest, const std::function<CurvePair(const CurvePair&)>& pose) {
  Pose out;
  for (const CurvePair& pair : rest) out.push_back(pose(pair));
  return out;
}

/// From gentle bends to folds, twists of several turns, and control points thrown about.
inline Pose random_pose(const Pose& rest, Random& random) {
  const double bend = random.uniform(-8.0, 8.0);
  const double twist = random.uniform(-15.0, 15.0);
  const double size = random.integer(2) == 0 ? 0.0 : std::exp(random.uniform(-8.0, 0.0));
  return each(rest, [&](const CurvePair& pair) { return shaken(bent(pair, bend, twist), size, random); });
}

/// A tube with an axis for each half and one across, so that points have places on several.
inline BoundMesh bound_to_three() {
  bind::BindOptions options;
  options.mode = bind::BindMode::continuous;
  options.band = 1.0;
  const auto line = [](const Vec3& from, const Vec3& to) {
    std::vector<Vec3> p;
    for (int i = 0; i < 6; ++i) p.push_back(from + (to - from) * (i / 5.0));
    return pair_through(p, Vec3(0.1, 0.2, 1.0).normalized(), 0.1);
  };
  return {{line({0.05, 0, 0}, {0.45, 0, 0}), line({0.55, 0, 0}, {0.95, 0, 0}),
           line({0.5, -0.1, 0}, {0.5, 0.1, 0})},
          tube(40, 24, 0.15),
          options};
}

inline collision::Box box_of(const std::vector<Vec3>& at, const Triangle& t) {
  return {at[t[0]].cwiseMin(at[t[1]]).cwiseMin(at[t[2]]), at[t[0]].cwiseMax(at[t[1]]).cwiseMax(at[t[2]])};
}

}  // namespace tendril::test
