#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

/// Neighbourhoods of a mesh, and functions on its points that may not change fast.
namespace tendril::bind {

/// Neighbours by an edge of a face, ascending, of point i: `to[begin[i] .. begin[i + 1])`.
struct Neighbours {
  std::vector<std::uint32_t> begin, to;

  Neighbours() = default;
  explicit Neighbours(const PolygonMesh& mesh);
  /// \param pairs  each of two neighbours both ways; any may be there several times
  Neighbours(std::size_t points, std::vector<std::array<std::uint32_t, 2>> pairs);
  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(to).subspan(begin[point], begin[point + 1] - begin[point]);
  }
};

/// Lowers a function on the points of a mesh to the largest below it that grows along no edge by more than
/// allowed, by Dijkstra's algorithm [Dijkstra 1959]. The bound holds for every edge, so splitting the edges
/// does not change it.
///
/// \param value  of a point: a reference to the function there
///
/// \param growth  of a point and a length: by how much, at least 0, the function may grow over an edge so
/// long that ends there
template <class Value, class Growth>
void bound_growth(Points points, const Neighbours& neighbours, const Value& value, const Growth& growth) {
  using Number = std::decay_t<decltype(value(0))>;
  using Entry = std::pair<Number, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting;
  const auto spread = [&](std::uint32_t from) {
    for (const std::uint32_t next : neighbours.of(from)) {
      if (!(value(from) < value(next))) continue;  // which no growth of 0 or more brings down
      const double length = (points[next] - points[from]).norm();
      const auto most = static_cast<Number>(static_cast<double>(value(from)) + growth(next, length));
      if (!(most < value(next))) continue;
      value(next) = most;
      waiting.push({most, next});
    }
  };
  // The highest bring nobody down, and are most of the points where a function is capped.
  Number highest = std::numeric_limits<Number>::lowest();
  for (std::uint32_t i = 0; i < points.size(); ++i) highest = std::max<Number>(highest, value(i));
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (value(i) < highest) spread(i);
  while (!waiting.empty()) {
    const auto [reached, i] = waiting.top();
    waiting.pop();
    if (!(reached > value(i))) spread(i);
  }
}

}  // namespace tendril::bind
