#include "neighbours.h"

#include <array>

namespace tendril::bind {

Neighbours::Neighbours(const PolygonMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      edges.push_back({a, b});
      edges.push_back({b, a});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  begin.assign(mesh.points.size() + 1, 0);
  for (const auto& edge : edges) {
    ++begin[edge[0] + 1];
    to.push_back(edge[1]);
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

}  // namespace tendril::bind
