#include "merge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;
using Cell = std::array<std::int64_t, 3>;

/// Kept points by cells as wide as the distance: what is near stands in one of 27.
class Kept {
 public:
  Kept(const std::vector<Vec3>& points, double distance)
      : points_(points), distance_(distance), low_(points.front()) {
    for (const Vec3& p : points) low_ = low_.cwiseMin(p);
  }

  std::optional<std::uint32_t> near(const Vec3& p) const {
    std::optional<std::uint32_t> found;
    const Cell at = cell_of(p);
    for (int k = 0; k < 27; ++k) {
      const auto cell = cells_.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
      if (cell == cells_.end()) continue;
      for (const std::uint32_t i : cell->second)
        if ((points_[i] - p).norm() <= distance_ && (!found || i < *found)) found = i;
    }
    return found;
  }
  void keep(std::uint32_t i) { cells_[cell_of(points_[i])].push_back(i); }

 private:
  // At most 1e12 cells a side: see merge_targets.
  Cell cell_of(const Vec3& p) const {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      cell[k] = static_cast<std::int64_t>(std::floor((p[axis] - low_[axis]) / distance_));
    }
    return cell;
  }

  const std::vector<Vec3>& points_;
  double distance_;
  Vec3 low_;
  std::map<Cell, Ids> cells_;
};

}  // namespace

std::vector<std::uint32_t> merge_targets(const PolygonMesh& mesh, double distance) {
  Ids to(mesh.points.size());
  std::iota(to.begin(), to.end(), 0U);
  for (const Duplicate& one : inspect(mesh).duplicate_points) to[one.id] = one.first;
  const double diagonal = bounding_diagonal(mesh.points);
  // Closer than rounding makes them, or beyond what can be squared: equal points alone.
  if (!(distance >= 1e-12) || !std::isfinite(diagonal) || !(diagonal > 0.0)) return to;
  Kept kept(mesh.points, distance * diagonal);
  for (std::uint32_t i = 0; i < to.size(); ++i) {
    if (const auto near = kept.near(mesh.points[i]))
      to[i] = *near;
    else
      kept.keep(i);
  }
  return to;
}

std::vector<Edge> open_edges(const PolygonMesh& mesh) {
  std::vector<Edge> all, once;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (a != b) all.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end] == all[i]) ++end;
    if (end == i + 1) once.push_back(all[i]);
    i = end;
  }
  return once;
}

}  // namespace tendril::bind
