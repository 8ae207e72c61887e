#include "islands.h"

#include <algorithm>
#include <limits>

namespace tendril::bind {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// Points nearest to one curve-pair, joined by edges.
struct Area {
  std::uint32_t pair;
  std::vector<std::uint32_t> points;
  double low = std::numeric_limits<double>::infinity(), high = -low;  ///< parameters
  double away = 0.0, weight = 0.0;  ///< how far its faces look away from the axis, at most the weight
};

/// Sums of the neighbouring faces' normals, as long as the faces are large.
std::vector<Vec3> normals(const PolygonMesh& mesh) {
  std::vector<Vec3> out(mesh.points.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const Vec3& p = mesh.points[face[0]];
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < face.size(); ++k)
      normal += (mesh.points[face[k - 1]] - p).cross(mesh.points[face[k]] - p);
    for (const std::uint32_t i : face) out[i] += normal;
  }
  return out;
}

std::vector<Area> areas(const Neighbours& neighbours, std::span<const Candidate> nearest,
                        std::vector<std::uint32_t>& area_of) {
  std::vector<Area> out;
  area_of.assign(nearest.size(), kNone);
  for (std::uint32_t start = 0; start < nearest.size(); ++start) {
    if (area_of[start] != kNone) continue;
    Area area{nearest[start].pair, {start}};
    area_of[start] = static_cast<std::uint32_t>(out.size());
    for (std::size_t k = 0; k < area.points.size(); ++k)
      for (const std::uint32_t next : neighbours.of(area.points[k])) {
        if (area_of[next] != kNone || nearest[next].pair != area.pair) continue;
        area_of[next] = area_of[start];
        area.points.push_back(next);
      }
    std::sort(area.points.begin(), area.points.end());
    out.push_back(std::move(area));
  }
  return out;
}

void measure(Area& area, const PolygonMesh& mesh, std::span<const Vec3> normal,
             std::span<const Candidate> nearest) {
  for (const std::uint32_t i : area.points) {
    area.low = std::min(area.low, nearest[i].at.t);
    area.high = std::max(area.high, nearest[i].at.t);
    const Vec3 offset = mesh.points[i] - nearest[i].at.point;
    if (nearest[i].at.distance > 0.0) area.away += offset.dot(normal[i]) / nearest[i].at.distance;
    area.weight += normal[i].norm();
  }
}

bool turned_apart(const Area& a, const Area& b) {
  constexpr double clearly = 0.1;
  return a.away * b.away < 0.0 && std::abs(a.away) > clearly * a.weight &&
         std::abs(b.away) > clearly * b.weight;
}

bool is_island(const Area& area, std::span<const Area> all) {
  return std::any_of(all.begin(), all.end(), [&](const Area& other) {
    return other.pair == area.pair && other.points.size() > area.points.size() && other.low <= area.low &&
           other.high >= area.high && turned_apart(area, other);
  });
}

}  // namespace

std::vector<Island> find_islands(const PolygonMesh& mesh, const Neighbours& neighbours,
                                 std::span<const Candidate> nearest) {
  std::vector<std::uint32_t> area_of;
  std::vector<Area> all = areas(neighbours, nearest, area_of);
  const std::vector<Vec3> normal = normals(mesh);
  for (Area& area : all) measure(area, mesh, normal, nearest);
  std::vector<bool> island;
  for (const Area& area : all) island.push_back(is_island(area, all));
  std::vector<Island> out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!island[k]) continue;
    Island one{all[k].points, {}};
    for (const std::uint32_t i : one.points)
      for (const std::uint32_t next : neighbours.of(i))
        if (!island[area_of[next]]) one.pairs.push_back(nearest[next].pair);
    std::sort(one.pairs.begin(), one.pairs.end());
    one.pairs.erase(std::unique(one.pairs.begin(), one.pairs.end()), one.pairs.end());
    if (!one.pairs.empty()) out.push_back(std::move(one));
  }
  return out;
}

}  // namespace tendril::bind
