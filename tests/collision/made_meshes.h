#pragma once

#include <tendril/base/types.h>

#include <cmath>
#include <cstdint>
#include <vector>

/// Closed meshes made up of triangles.
namespace tendril::test {

struct MadeMesh {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> corners;
};

/// A cube of side 2 about the origin, each side in n x n squares of two triangles; edges and corners are
/// whole numbers over n.
inline MadeMesh cube(int n) {
  MadeMesh m;
  for (int side = 0; side < 6; ++side) {
    const int k = side / 2, i = (k + 1) % 3, j = (k + 2) % 3;
    const double z = side % 2 == 0 ? -1 : 1;
    for (int u = 0; u < n; ++u)
      for (int v = 0; v < n; ++v) {
        const auto at = [&](int du, int dv) {
          Vec3 x;
          x[k] = z;
          x[i] = -1 + 2.0 * (u + du) / n;
          x[j] = -1 + 2.0 * (v + dv) / n;
          return x;
        };
        const auto first = static_cast<std::uint32_t>(m.points.size());
        for (const Vec3& x : {at(0, 0), at(1, 0), at(1, 1), at(0, 1)}) m.points.push_back(x);
        const bool out = z > 0;
        for (const std::uint32_t c : {0, out ? 1 : 2, out ? 2 : 1, 0, out ? 2 : 3, out ? 3 : 2})
          m.corners.push_back(first + c);
      }
  }
  return m;
}

/// A wavy ball about the origin: radius 1 + 0.2 sin(3 a) in longitude a.
inline MadeMesh wavy_ball(int n) {
  MadeMesh m;
  const auto ring = [n](int i) { return static_cast<std::uint32_t>(1 + (i - 1) * 2 * n); };
  m.points.emplace_back(0, 0, -1);
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double lat = M_PI * (static_cast<double>(i) / n - 0.5), lon = M_PI * j / n;
      const double r = 1 + 0.2 * std::sin(3 * lon);
      m.points.emplace_back(r * std::cos(lat) * std::cos(lon), r * std::cos(lat) * std::sin(lon),
                            std::sin(lat));
    }
  m.points.emplace_back(0, 0, 1);
  const auto top = static_cast<std::uint32_t>(m.points.size() - 1),
             around = static_cast<std::uint32_t>(2 * n);
  for (std::uint32_t j = 0; j < around; ++j) {
    const std::uint32_t next = (j + 1) % around;
    for (const std::uint32_t c : {0u, ring(1) + next, ring(1) + j}) m.corners.push_back(c);
    for (const std::uint32_t c : {top, ring(n - 1) + j, ring(n - 1) + next}) m.corners.push_back(c);
    for (int i = 1; i + 1 < n; ++i)
      for (const std::uint32_t c : {ring(i) + j, ring(i) + next, ring(i + 1) + next, ring(i) + j,
                                    ring(i + 1) + next, ring(i + 1) + j})
        m.corners.push_back(c);
  }
  return m;
}

}  // namespace tendril::test
