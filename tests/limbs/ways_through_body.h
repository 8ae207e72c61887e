#pragma once

#include <tendril/bind/polygon_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

/// How far points of a skin are from a limb's axis by ways through the body, in voxels: the oracle of
/// [Dionne and de Lasa 2013], which shares nothing with the binding.
namespace tendril::test {

class WaysThroughBody {
 public:
  /// \param cells  along the longest side of the mesh
  WaysThroughBody(const bind::PolygonMesh& mesh, int cells) : mesh_(mesh) {
    Vec3 low = mesh.points[0], high = low;
    for (const Vec3& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    size_ = (high - low).maxCoeff() / cells;
    // Off the round numbers on which meshes have their points.
    low_ = low - size_ * Vec3(2.317, 2.473, 2.611);
    for (std::size_t k = 0; k < 3; ++k)
      count_[k] = static_cast<long>((high - low_)[static_cast<Eigen::Index>(k)] / size_) + 3;
    fill();
    find_normals();
  }

  double cell() const { return size_; }

  /// Of each cell, from the nearest of some points, by the middles of cells in the body. Infinite where no
  /// way leads.
  std::vector<float> from(const std::vector<Vec3>& points) const {
    using Entry = std::pair<float, long>;
    std::vector<float> way(inside_.size(), std::numeric_limits<float>::infinity());
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
    for (const Vec3& p : points)
      each_near(p, 1, [&](long at) {
        const auto d = static_cast<float>((middle(at) - p).norm());
        if (inside_[static_cast<std::size_t>(at)] && d < way[static_cast<std::size_t>(at)])
          next.emplace(way[static_cast<std::size_t>(at)] = d, at);
      });
    while (!next.empty()) {
      const float d = next.top().first;
      const long at = next.top().second;
      next.pop();
      if (d > way[static_cast<std::size_t>(at)]) continue;
      each_near(middle(at), 1, [&](long to) {
        const auto t = static_cast<std::size_t>(to);
        if (!inside_[t]) return;
        const float longer = d + static_cast<float>((middle(to) - middle(at)).norm());
        if (longer < way[t]) next.emplace(way[t] = longer, to);
      });
    }
    return way;
  }

  /// Of a point of the mesh, by the cells beside it on the inner side of its skin.
  double at(const std::vector<float>& way, std::size_t point) const {
    double least = std::numeric_limits<double>::infinity();
    const Vec3& p = mesh_.points[point];
    each_near(p, 2, [&](long cell) {
      const Vec3 there = middle(cell) - p;
      if (inside_[static_cast<std::size_t>(cell)] && there.dot(normal_[point]) <= 0.0)
        least = std::min(least, static_cast<double>(way[static_cast<std::size_t>(cell)]) + there.norm());
    });
    return least;
  }

 private:
  Vec3 middle(long at) const {
    return low_ + size_ * Vec3(0.5 + static_cast<double>(at % count_[0]),
                               0.5 + static_cast<double>(at / count_[0] % count_[1]),
                               0.5 + static_cast<double>(at / count_[0] / count_[1]));
  }
  /// Numbers of the cells at most so many from the one that holds a point.
  template <class Visit>
  void each_near(const Vec3& p, long reach, const Visit& visit) const {
    std::array<long, 3> c{}, a{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      c[k] = static_cast<long>(std::floor((p[i] - low_[i]) / size_));
      a[k] = std::max(0L, c[k] - reach), b[k] = std::min(count_[k] - 1, c[k] + reach);
    }
    for (long z = a[2]; z <= b[2]; ++z)
      for (long y = a[1]; y <= b[1]; ++y)
        for (long x = a[0]; x <= b[0]; ++x) visit(x + count_[0] * (y + count_[1] * z));
  }

  template <class Visit>
  void each_triangle(const Visit& visit) const {
    for (std::size_t f = 0; f < mesh_.face_count(); ++f)
      for (std::size_t k = 2; k < mesh_.face(f).size(); ++k)
        visit(std::array<std::uint32_t, 3>{mesh_.face(f)[0], mesh_.face(f)[k - 1], mesh_.face(f)[k]});
  }

  /// A cell is in the body where a row along x through its middle has met more surfaces that look back than
  /// ahead, or fewer: holes of parts within parts are filled, and either orientation is right.
  void fill() {
    inside_.assign(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]), 0);
    std::vector<std::vector<std::pair<double, int>>> met(static_cast<std::size_t>(count_[1] * count_[2]));
    each_triangle([&](const std::array<std::uint32_t, 3>& corner) {
      const Vec3 &a = mesh_.points[corner[0]], &b = mesh_.points[corner[1]], &c = mesh_.points[corner[2]];
      const Vec3 n = (b - a).cross(c - a);
      if (n.x() == 0.0) return;
      const Vec3 low = (a.cwiseMin(b).cwiseMin(c) - low_) / size_,
                 high = (a.cwiseMax(b).cwiseMax(c) - low_) / size_;
      for (long z = std::lround(low.z()); z < std::lround(high.z()); ++z)
        for (long y = std::lround(low.y()); y < std::lround(high.y()); ++y) {
          const Vec3 p = low_ + size_ * Vec3(0.0, 0.5 + static_cast<double>(y), 0.5 + static_cast<double>(z));
          const auto side = [&](const Vec3& from, const Vec3& to) {
            return (to.y() - from.y()) * (p.z() - from.z()) - (to.z() - from.z()) * (p.y() - from.y()) > 0.0;
          };
          if (side(a, b) != side(b, c) || side(b, c) != side(c, a)) continue;
          const double x = a.x() - ((p.y() - a.y()) * n.y() + (p.z() - a.z()) * n.z()) / n.x();
          met[static_cast<std::size_t>(y + count_[1] * z)].emplace_back(x, n.x() < 0.0 ? 1 : -1);
        }
    });
    for (std::size_t row = 0; row < met.size(); ++row) {
      std::sort(met[row].begin(), met[row].end());
      int winding = 0;
      std::size_t next = 0;
      for (long x = 0; x < count_[0]; ++x) {
        const double at = low_.x() + size_ * (0.5 + static_cast<double>(x));
        for (; next < met[row].size() && met[row][next].first < at; ++next) winding += met[row][next].second;
        inside_[row * static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(x)] = winding != 0;
      }
    }
  }

  void find_normals() {
    normal_.assign(mesh_.points.size(), Vec3::Zero());
    double volume = 0.0;
    each_triangle([&](const std::array<std::uint32_t, 3>& corner) {
      const Vec3 &a = mesh_.points[corner[0]], &b = mesh_.points[corner[1]], &c = mesh_.points[corner[2]];
      for (const std::uint32_t i : corner) normal_[i] += (b - a).cross(c - a);
      volume += (a - low_).dot((b - low_).cross(c - low_));
    });
    if (volume < 0.0)
      for (Vec3& n : normal_) n = -n;
  }

  const bind::PolygonMesh& mesh_;
  double size_ = 0.0;
  Vec3 low_ = Vec3::Zero();
  std::array<long, 3> count_{};
  std::vector<char> inside_;
  std::vector<Vec3> normal_;
};

}  // namespace tendril::test
