#include "rig/refine.h"

#include <algorithm>
#include <map>

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

}  // namespace tendril::runner
