#include "mesh_springs.h"

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

}  // namespace tendril::gallery
