#include "mesh_springs.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tendril::gallery {

SpringNet cloth_net(std::span<const Vec3> points, int columns, int rows, double mass,
                    const ClothSprings& springs) {
  SpringNet net{{points.begin(), points.end()}, {}, {}};
  net.mass.assign(points.size(), mass / static_cast<double>(points.size()));
  const auto join = [&](int c, int r, int dc, int dr, double stiffness) {
    if (c + dc >= columns || r + dr >= rows) return;
    const auto a = static_cast<std::uint32_t>(r * columns + c);
    const auto b = static_cast<std::uint32_t>((r + dr) * columns + c + dc);
    net.springs.push_back(spring_between(points, a, b, stiffness));
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      join(c, r, 1, 0, springs.structural);
      join(c, r, 0, 1, springs.structural);
      if (r % 2 == 0 && c % 2 == 0) {
        join(c, r, 2, 0, springs.bending);
        join(c, r, 0, 2, springs.bending);
      }
      if (r + 1 == rows || c + 1 == columns) continue;
      const auto at = [&](int dc, int dr) { return static_cast<std::uint32_t>((r + dr) * columns + c + dc); };
      const bool rising = (r + c) % 2 == 1;
      net.springs.push_back(
          spring_between(points, at(rising ? 1 : 0, 0), at(rising ? 0 : 1, 1), springs.shear));
    }
  return net;
}

SpringNet closed_mesh_net(std::span<const Vec3> points,
                          std::span<const std::array<std::uint32_t, 3>> triangles, double mass,
                          double stiffness) {
  SpringNet net{{points.begin(), points.end()}, {}, {}};
  net.mass.assign(points.size(), mass / static_cast<double>(points.size()));
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
      facing;  // the corner of the first triangle
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
      const auto [at, first] = facing.try_emplace(std::minmax(a, b), c);
      net.springs.push_back(first ? spring_between(points, a, b, stiffness)
                                  : spring_between(points, at->second, c, stiffness));
    }
  return net;
}

}  // namespace tendril::gallery
