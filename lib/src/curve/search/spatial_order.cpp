#include "spatial_order.h"

#include <algorithm>
#include <array>

namespace tendril {
namespace {

/// So many bits, each with two zeros before it.
std::uint32_t spread(std::uint32_t bits) {
  std::uint32_t out = 0;
  for (std::uint32_t i = 0; i < 5; ++i) out |= (bits >> i & 1u) << (3 * i);
  return out;
}

/// Cells a side, as a power of two: so many that a surface has some points in each.
std::uint32_t bits_for(std::size_t points) {
  std::uint32_t bits = 1;
  while (bits < 5 && (std::size_t{8} << (2 * bits)) < points) ++bits;
  return bits;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(Points points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  const std::uint32_t bits = bits_for(points.size()), side = 1u << bits;
  std::array<std::uint32_t, 32> spreads{};
  for (std::uint32_t i = 0; i < side; ++i) spreads[i] = spread(i);
  const double longest = box.sizes().maxCoeff();
  const double scale = longest > 1e-300 ? side / longest : 0.0;
  const auto along = [&](double x, double low) {
    return spreads[std::min(static_cast<std::uint32_t>((x - low) * scale), side - 1)];
  };
  std::vector<std::uint16_t> cell(points.size());
  std::vector<std::uint32_t> begin((std::size_t{1} << (3 * bits)) + 1, 0), order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    cell[i] = static_cast<std::uint16_t>(along(p.x(), box.min().x()) << 2 | along(p.y(), box.min().y()) << 1 |
                                         along(p.z(), box.min().z()));
    ++begin[cell[i] + 1u];
  }
  for (std::size_t c = 1; c < begin.size(); ++c) begin[c] += begin[c - 1];
  for (std::size_t i = 0; i < points.size(); ++i) order[begin[cell[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}

}  // namespace tendril
