#include "rig/refine.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tendril::runner {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t kMostTriangles = 400000;

class Splitter {
 public:
  explicit Splitter(std::vector<Vec3>& points) : points_(points) {}

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] = middles_.try_emplace(std::minmax(a, b), points_.size());
    if (is_new) points_.emplace_back(0.5 * points_[a] + 0.5 * points_[b]);
    return at->second;
  }

  bool is_long(const Triangle& t, double longest) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if ((points_[t[k]] - points_[t[(k + 1) % 3]]).stableNorm() > longest) return true;
    }
    return false;
  }

 private:
  std::vector<Vec3>& points_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

/// Points that faces, or their places, make one.
class Parts {
 public:
  explicit Parts(const bind::PolygonMesh& mesh) : parent_(mesh.points.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    std::vector<std::uint32_t> order = parent_;
    const auto place = [&](std::uint32_t i) {
      const Vec3& p = mesh.points[i];
      return std::array{p.x(), p.y(), p.z()};
    };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
    for (std::size_t i = 1; i < order.size(); ++i)
      if (place(order[i]) == place(order[i - 1])) join(order[i], order[i - 1]);
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
      for (const std::uint32_t corner : mesh.face(f)) join(corner, mesh.face(f)[0]);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

  std::vector<std::uint32_t> parent_;
};

}  // namespace

bind::PolygonMesh split_long_edges(const bind::PolygonMesh& mesh, double longest) {
  bind::PolygonMesh out;
  out.points = mesh.points;
  Splitter splitter(out.points);
  std::vector<Triangle> now = bind::fan_triangles(mesh);
  for (bool any = true; any;) {
    any = false;
    std::vector<Triangle> next;
    std::size_t left = now.size();
    for (const Triangle& t : now) {
      --left;
      if (next.size() + left + 4 > kMostTriangles || !splitter.is_long(t, longest)) {
        next.push_back(t);
        continue;
      }
      any = true;
      const std::uint32_t a = splitter.middle(t[0], t[1]), b = splitter.middle(t[1], t[2]),
                          c = splitter.middle(t[2], t[0]);
      for (const Triangle& part : {Triangle{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}})
        next.push_back(part);
    }
    now = std::move(next);
  }
  for (const Triangle& t : now) {
    out.corners.insert(out.corners.end(), t.begin(), t.end());
    out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
  }
  return out;
}

bind::PolygonMesh largest_part(const bind::PolygonMesh& mesh) {
  Parts parts(mesh);
  std::vector<double> area(mesh.points.size(), 0.0);
  for (const auto& [a, b, c] : bind::fan_triangles(mesh))
    area[parts.root(a)] += (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
  const auto largest = static_cast<std::uint32_t>(std::max_element(area.begin(), area.end()) - area.begin());
  constexpr auto kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(mesh.points.size(), kNone);
  bind::PolygonMesh out;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (parts.root(mesh.face(f)[0]) != largest) continue;
    for (const std::uint32_t corner : mesh.face(f)) {
      if (number[corner] == kNone) {
        number[corner] = static_cast<std::uint32_t>(out.points.size());
        out.points.push_back(mesh.points[corner]);
      }
      out.corners.push_back(number[corner]);
    }
    out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
  }
  return out;
}

}  // namespace tendril::runner
