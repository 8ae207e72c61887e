#pragma once

#include <tendril/collision/hierarchy_options.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/minkowski.h"
#include "support/random.h"

/// Where points and balls lie to a mesh, by looking at all triangles, in whole numbers where doubles leave a
/// doubt: a witness that shares nothing with the library but the definition.
namespace tendril::test {

/// The sign of det(a, b, c), by a filter with a margin of 50 times what rounding can do, then in whole
/// numbers.
/// \param from  a, b and c are differences of `to` and `from`, but for a where it is a vector itself
inline int volume_sign(const Vec3& a, bool a_is_vector, const Vec3& b, const Vec3& c, const Vec3& from) {
  const Vec3 x = a_is_vector ? a : Vec3(a - from), y = b - from, z = c - from;
  const double det = x.dot(y.cross(z));
  const Vec3 m = y.cwiseAbs(), n = z.cwiseAbs();
  const double size = std::abs(x[0]) * (m[1] * n[2] + m[2] * n[1]) +
                      std::abs(x[1]) * (m[2] * n[0] + m[0] * n[2]) +
                      std::abs(x[2]) * (m[0] * n[1] + m[1] * n[0]);
  if (std::abs(det) > 1e-13 * size && size > 1e-200 && size < 1e200) return det > 0 ? 1 : -1;
  const std::array<Vec3, 4> all{a, b, c, from};
  const int e = unit_exponent(all);
  const auto whole = [e](const Vec3& p) {
    return Whole3{in_units(p.x(), e), in_units(p.y(), e), in_units(p.z(), e)};
  };
  const Whole3 o = whole(from), first = a_is_vector ? whole(a) : whole(a) - o;
  return dot(first, cross(whole(b) - o, whole(c) - o)).sign();
}

class MeshTruth {
 public:
  MeshTruth(std::vector<Vec3> points, std::vector<collision::Triangle> triangles)
      : points_(std::move(points)), triangles_(std::move(triangles)), oriented_(as_many_either_way()) {}

  /// With what a closed mesh goes round, or where its triangles are not turned alike encloses by parity: hit
  /// within, touching on it.
  collision::Relation inside(const Vec3& x) const {
    const std::array<Vec3, 1> point{x};
    for (const auto& t : triangles_) {
      const std::array<Vec3, 3> c = corners(t);
      if (square_to_box(c, x) == 0.0 && minkowski_relation(point, c) != collision::Relation::free)
        return collision::Relation::touching;
    }
    const Crossed crossed = crossings(x);
    return (oriented_ ? crossed.winding != 0 : crossed.all % 2 != 0) ? collision::Relation::hit
                                                                     : collision::Relation::free;
  }
  /// Whether a point that is on no triangle is gone round an even number of times, but not 0: libraries
  /// that count crossings call it outside.
  bool is_gone_round_evenly(const Vec3& x) const {
    const Crossed crossed = crossings(x);
    return crossed.winding != 0 && crossed.all % 2 == 0;
  }

  /// With the surface of the mesh.
  collision::Relation ball(const Vec3& centre, double radius) const {
    const std::array<Vec3, 1> point{centre};
    collision::Relation most = collision::Relation::free;
    for (const auto& t : triangles_) {
      const std::array<Vec3, 3> c = corners(t);
      if (square_to_box(c, centre) > radius * radius * (1 + 1e-9)) continue;
      const Vec3 r(radius, 0, 0);
      const int e = std::min(common_exponent(point, c), unit_exponent(Points(&r, 1)));
      const Whole whole = in_units(radius, e);
      const Ratio square = minkowski_square(point, c, e), limit = Ratio(Whole(whole * whole));
      if (square < limit) return collision::Relation::hit;
      if (square == limit) most = collision::Relation::touching;
    }
    return most;
  }

  std::array<Vec3, 3> corners(const collision::Triangle& t) const {
    return {points_[t[0]], points_[t[1]], points_[t[2]]};
  }
  const std::vector<collision::Triangle>& triangles() const { return triangles_; }

 private:
  static double square_to_box(const std::array<Vec3, 3>& t, const Vec3& x) {
    const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    return (low - x).cwiseMax(x - high).cwiseMax(0.0).squaredNorm();
  }

  /// Every edge is there as often one way round as the other.
  bool as_many_either_way() const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : triangles_)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
  }

  struct Crossed {
    int all = 0, winding = 0;
  };
  Crossed crossings(const Vec3& x) const {
    Random random(1);
    while (true)
      if (const auto crossed = crossings(x, random.in_cube())) return *crossed;
  }
  /// Triangles that the ray from x along a direction crosses; nothing where it meets an edge. x is on none.
  std::optional<Crossed> crossings(const Vec3& x, const Vec3& along) const {
    Crossed crossed;
    for (const auto& t : triangles_) {
      const std::array<Vec3, 3> c = corners(t);
      const int s[3] = {volume_sign(along, true, c[0], c[1], x), volume_sign(along, true, c[1], c[2], x),
                        volume_sign(along, true, c[2], c[0], x)};
      const bool up = s[0] >= 0 && s[1] >= 0 && s[2] >= 0, down = s[0] <= 0 && s[1] <= 0 && s[2] <= 0;
      if (!up && !down) continue;
      if (s[0] == 0 || s[1] == 0 || s[2] == 0) return {};
      if (volume_sign(c[0], false, c[1], c[2], x) != s[0]) continue;
      ++crossed.all;
      crossed.winding += s[0];
    }
    return crossed;
  }

  std::vector<Vec3> points_;
  std::vector<collision::Triangle> triangles_;
  bool oriented_;
};

}  // namespace tendril::test
