#include "split.h"

#include <tendril/bind/judge.h>

#include <algorithm>

namespace tendril::bind {

TriangleMesh::TriangleMesh(const PolygonMesh& body) {
  mesh.points = body.points;
  for (std::size_t f = 0; f < body.face_count(); ++f) {
    const auto face = body.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) {
      mesh.corners.insert(mesh.corners.end(), {face[0], face[k - 1], face[k]});
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
      face_of.push_back(static_cast<std::uint32_t>(f));
    }
  }
  find_edges();
}

void TriangleMesh::find_edges() {
  edges.reserve(mesh.corners.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

std::size_t TriangleMesh::edge_of(std::uint32_t a, std::uint32_t b) const {
  const PointPair edge{std::min(a, b), std::max(a, b)};
  return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
}

std::vector<std::uint32_t> TriangleMesh::faces_of_edges() const {
  std::vector<std::uint32_t> out(edges.size());
  for (std::size_t f = mesh.face_count(); f-- > 0;) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < 3; ++k)
      if (face[k] != face[(k + 1) % 3]) out[edge_of(face[k], face[(k + 1) % 3])] = face_of[f];
  }
  return out;
}

TriangleMesh TriangleMesh::split() const {
  TriangleMesh out;
  out.mesh.points = mesh.points;
  out.mesh.points.reserve(mesh.points.size() + edges.size());
  for (const auto& [a, b] : edges) out.mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    return a == b ? a : static_cast<std::uint32_t>(mesh.points.size() + edge_of(a, b));
  };
  out.mesh.corners.reserve(4 * mesh.corners.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    const std::uint32_t a = face[0], b = face[1], c = face[2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.mesh.corners.insert(out.mesh.corners.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    for (int k = 0; k < 4; ++k) {
      out.mesh.face_begin.push_back(out.mesh.face_begin.back() + 3);
      out.face_of.push_back(face_of[f]);
    }
  }
  out.find_edges();
  return out;
}

PolygonMesh split_at_middles(const PolygonMesh& mesh) {
  return TriangleMesh(mesh).split().mesh;
}

}  // namespace tendril::bind
