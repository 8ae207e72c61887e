#include "cell_order.h"

#include <algorithm>
#include <numeric>

namespace tendril::collision {
namespace {

constexpr std::size_t kAxes = 5;  // pair, t, u, v, w
using Key = std::array<float, kAxes>;

double length_per_parameter(const CurvePair& pair) {
  const Points u = pair.primary().control_points();
  double length = 0.0;
  for (std::size_t i = 1; i < u.size(); ++i) length += (u[i] - u[i - 1]).norm();
  return length / (pair.knots().end() - pair.knots().start());
}

std::vector<Key> keys_of_points(std::span<const CurvePair> rest, const BoundPoints& points) {
  std::vector<double> scale;
  for (const CurvePair& pair : rest) scale.push_back(length_per_parameter(pair));
  std::vector<Key> keys(points.size());
  std::vector<BoundShare> shares;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    points.shares(i, shares);
    const AxialPoint& at = shares.front().record;
    keys[i] = {static_cast<float>(shares.front().pair), static_cast<float>(at.t * scale[shares.front().pair]),
               static_cast<float>(at.u), static_cast<float>(at.v), static_cast<float>(at.w)};
  }
  return keys;
}

/// Sums over the corners: what is three times the middle sorts as well.
std::vector<Key> keys_of_triangles(const std::vector<Key>& points, std::span<const Triangle> triangles) {
  std::vector<Key> keys(triangles.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    for (std::size_t a = 0; a < kAxes; ++a)
      keys[i][a] = points[triangles[i][0]][a] + points[triangles[i][1]][a] + points[triangles[i][2]][a];
  return keys;
}

std::size_t widest(const std::vector<Key>& keys, std::span<const std::uint32_t> items) {
  Key low = keys[items.front()], high = low;
  for (const std::uint32_t i : items)
    for (std::size_t a = 0; a < kAxes; ++a) {
      low[a] = std::min(low[a], keys[i][a]);
      high[a] = std::max(high[a], keys[i][a]);
    }
  if (high[0] > low[0]) return 0;
  std::size_t best = 1;
  for (std::size_t a = 2; a < kAxes; ++a)
    if (high[a] - low[a] > high[best] - low[best]) best = a;
  return best;
}

void sort(const PlacedCells::Node& n, const std::vector<Key>& keys, std::vector<std::uint32_t>& order) {
  if (n.leaf()) return;
  constexpr std::size_t leaf = PlacedCells::kLeaf;
  const std::size_t begin = n.begin * leaf, end = std::min(n.end * leaf, order.size());
  const std::size_t axis = widest(keys, std::span(order).subspan(begin, end - begin));
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at((n.begin + n.half()) * leaf), at(end),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return keys[a][axis] != keys[b][axis] ? keys[a][axis] < keys[b][axis] : a < b;
                   });
  sort(n.left(), keys, order);
  sort(n.right(), keys, order);
}

}  // namespace

std::vector<std::uint32_t> axial_order(std::span<const CurvePair> rest, const BoundPoints& points,
                                       std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  if (order.empty()) return order;
  sort({0, 0, 0, (order.size() + PlacedCells::kLeaf - 1) / PlacedCells::kLeaf},
       keys_of_triangles(keys_of_points(rest, points), triangles), order);
  return order;
}

CellPoints cell_points(std::span<const std::uint32_t> order, std::span<const Triangle> triangles,
                       std::size_t points) {
  constexpr std::size_t cell = PlacedCells::kLeaf * PlacedCells::kCell;
  CellPoints out;
  out.corner.resize(order.size());
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> place(points, none);
  for (std::size_t begin = 0; begin < order.size(); begin += cell) {
    const std::uint32_t first = out.begin.back();
    for (std::size_t i = begin; i < std::min(begin + cell, order.size()); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t point = triangles[order[i]][k];
        // A place below the cell's first is of an earlier cell.
        if (place[point] == none || place[point] < first) {
          place[point] = static_cast<std::uint32_t>(out.points.size());
          out.points.push_back(point);
        }
        out.corner[i][k] = static_cast<std::uint8_t>(place[point] - first);
      }
    out.begin.push_back(static_cast<std::uint32_t>(out.points.size()));
  }
  return out;
}

}  // namespace tendril::collision
