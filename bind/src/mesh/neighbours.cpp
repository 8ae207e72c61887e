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
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  begin.assign(points + 1, 0);
  for (const auto& pair : pairs) {
    ++begin[pair[0] + 1];
    to.push_back(pair[1]);
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

}  // namespace tendril::bind
