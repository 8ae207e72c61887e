#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

/// Closed surfaces whose axes are known.
namespace tendril::test {

/// Positive outside.
using Field = std::function<double(const Vec3&)>;

/// Distance to the segment from a to b, less r.
inline double capsule_field(const Vec3& p, const Vec3& a, const Vec3& b, double r) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - r;
}

/// Distance to the circle of radius `large` about the z axis, less r.
inline double torus_field(const Vec3& p, double large, double r) {
  return std::hypot(std::hypot(p.x(), p.y()) - large, p.z()) - r;
}

/// Where a field vanishes, by marching tetrahedra, six to each cube: a closed manifold when the box holds it.
class Isosurface {
 public:
  Isosurface(const Field& field, const Vec3& low, const Vec3& high, double step) : low_(low), step_(step) {
    for (int k = 0; k < 3; ++k) count_[k] = static_cast<int>(std::ceil((high[k] - low[k]) / step));
    value_.resize(static_cast<std::size_t>((count_[0] + 1) * (count_[1] + 1) * (count_[2] + 1)));
    for (std::size_t node = 0; node < value_.size(); ++node) value_[node] = field(at(node));
    for (int z = 0; z < count_[2]; ++z)
      for (int y = 0; y < count_[1]; ++y)
        for (int x = 0; x < count_[0]; ++x) cube({x, y, z});
  }
  const bind::PolygonMesh& mesh() const { return mesh_; }

 private:
  using Cell = std::array<int, 3>;
  std::size_t number(const Cell& c) const {
    return static_cast<std::size_t>(c[0] + (count_[0] + 1) * (c[1] + (count_[1] + 1) * c[2]));
  }
  Vec3 at(std::size_t node) const {
    const auto n = static_cast<int>(node);
    const int x = n % (count_[0] + 1), rest = n / (count_[0] + 1);
    return low_ + step_ * Vec3(x, rest % (count_[1] + 1), rest / (count_[1] + 1));
  }

  /// Along the ways from the cube's first corner to its last, one axis after another.
  void cube(const Cell& first) {
    std::array<int, 3> axes{0, 1, 2};
    do {
      std::array<std::size_t, 4> corner{};
      Cell c = first;
      corner[0] = number(c);
      for (std::size_t k = 0; k < 3; ++k) {
        ++c[static_cast<std::size_t>(axes[k])];
        corner[k + 1] = number(c);
      }
      tetrahedron(corner);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  void tetrahedron(const std::array<std::size_t, 4>& corner) {
    std::vector<std::size_t> in, out;
    for (const std::size_t c : corner) (value_[c] < 0.0 ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    if (in.size() == 2) {
      face({cut(in[0], out[0]), cut(in[0], out[1]), cut(in[1], out[1])}, in[0], out[0]);
      face({cut(in[0], out[0]), cut(in[1], out[1]), cut(in[1], out[0])}, in[0], out[0]);
      return;
    }
    const std::size_t one = in.size() == 1 ? in[0] : out[0];
    const auto& others = in.size() == 1 ? out : in;
    face({cut(one, others[0]), cut(one, others[1]), cut(one, others[2])}, in[0], out[0]);
  }
  std::uint32_t cut(std::size_t a, std::size_t b) {
    const auto [entry, made] =
        cuts_.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh_.points.size()));
    const double part = value_[a] / (value_[a] - value_[b]);
    if (made) mesh_.points.push_back(at(a) + part * (at(b) - at(a)));
    return entry->second;
  }
  void face(std::array<std::uint32_t, 3> f, std::size_t in, std::size_t out) {
    const Vec3& p = mesh_.points[f[0]];
    const Vec3 normal = (mesh_.points[f[1]] - p).cross(mesh_.points[f[2]] - p);
    if (normal.dot(at(out) - at(in)) < 0.0) std::swap(f[1], f[2]);
    mesh_.corners.insert(mesh_.corners.end(), f.begin(), f.end());
    mesh_.face_begin.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
  }

  Vec3 low_;
  double step_;
  std::array<int, 3> count_{};
  std::vector<double> value_;
  std::map<std::array<std::size_t, 2>, std::uint32_t> cuts_;
  bind::PolygonMesh mesh_;
};

/// About the segment from (-1, 0, 0) to (1, 0, 0), radius 0.2.
inline bind::PolygonMesh capsule(double step = 0.0501) {
  const Field field = [](const Vec3& p) { return capsule_field(p, -Vec3::UnitX(), Vec3::UnitX(), 0.2); };
  return Isosurface(field, Vec3(-1.31, -0.31, -0.32), Vec3(1.3, 0.3, 0.3), step).mesh();
}

/// About the unit circle, radius 0.25.
inline bind::PolygonMesh torus(double step = 0.0601) {
  const Field field = [](const Vec3& p) { return torus_field(p, 1.0, 0.25); };
  return Isosurface(field, Vec3(-1.41, -1.42, -0.33), Vec3(1.4, 1.4, 0.3), step).mesh();
}

/// Directions of the arms of the Y.
inline std::array<Vec3, 3> arms() {
  return {Vec3(0, -1.3, 0), Vec3(0.8, 0.7, 0.1), Vec3(-0.7, 0.8, 0)};
}

inline bind::PolygonMesh three_tubes(double step = 0.0501) {
  const Field field = [](const Vec3& p) {
    double least = 1e9;
    for (const Vec3& arm : arms()) least = std::min(least, capsule_field(p, Vec3::Zero(), arm, 0.15));
    return least;
  };
  return Isosurface(field, Vec3(-1.01, -1.53, -0.32), Vec3(1.1, 1.1, 0.4), step).mesh();
}

/// About the z axis from 0, with flat lids about their middles: rings of `round` points, one more than
/// `rings`.
inline bind::PolygonMesh cylinder(double length, double radius, std::uint32_t rings, std::uint32_t round) {
  bind::PolygonMesh mesh;
  const auto face = [&](std::initializer_list<std::uint32_t> corners) {
    mesh.corners.insert(mesh.corners.end(), corners);
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
  };
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t k = 0; k < round; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / round;
      mesh.points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), length * i / rings);
    }
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(0, 0, length);
  const std::uint32_t foot = round * (rings + 1), top = round * rings;
  for (std::uint32_t k = 0; k < round; ++k) {
    const std::uint32_t next = (k + 1) % round;
    for (std::uint32_t i = 0; i < rings; ++i) {
      const std::uint32_t a = i * round + k, b = i * round + next, c = b + round, d = a + round;
      face({a, b, c});
      face({a, c, d});
    }
    face({foot, next, k});
    face({foot + 1, top + k, top + next});
  }
  return mesh;
}

}  // namespace tendril::test
