#include "neighbours.h"

namespace tendril::bind {
namespace {

std::vector<std::array<std::uint32_t, 2>> edges_of(const PolygonMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      edges.push_back({a, b});
      edges.push_back({b, a});
    }
  }
  return edges;
}

}  // namespace

Neighbours::Neighbours(const PolygonMesh& mesh) : Neighbours(mesh.points.size(), edges_of(mesh)) {}

Neighbours::Neighbours(std::size_t points, std::vector<std::array<std::uint32_t, 2>> pairs) {
  // Counted into their places first: a sort of the few of each point is cheaper than one of all.
  std::vector<std::uint32_t> next(points + 1, 0), all(pairs.size());
  for (const auto& pair : pairs) ++next[pair[0] + 1];
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  begin = next;
  for (const auto& pair : pairs) all[next[pair[0]]++] = pair[1];
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const auto first = all.begin() + begin[i], last = all.begin() + begin[i + 1];
    std::sort(first, last);
    const auto end = std::unique(first, last);
    begin[i] = kept;
    to.insert(to.end(), first, end);
    kept += static_cast<std::uint32_t>(end - first);
  }
  begin[points] = kept;
}

}  // namespace tendril::bind
