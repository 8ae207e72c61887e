#include "self_mesh.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "contact/surfaces/span_list.h"

namespace tendril::contact {
namespace {

/// Faces of a patch: few, so that little is looked at where two come near; not so few that there are more
/// patches than pairs of faces to be saved.
constexpr std::size_t kMostFaces = 16;

/// Parts of a span that are bounded each alone: a clamped leaf hardly moves where it is held, though the span
/// that begins there does.
constexpr int kParts = 4;

using Faces = std::vector<std::uint32_t>;

Vec3 middle(const ContactSurface& surface, std::uint32_t face) {
  const auto& [a, b, c] = surface.triangles[face];
  return (surface.rest[a] + surface.rest[b] + surface.rest[c]) / 3.0;
}

/// Halves along the longest side of the box about the middles, until there are few enough.
void split(const ContactSurface& surface, Faces faces, std::vector<Faces>& out) {
  if (faces.size() <= kMostFaces) return out.push_back(std::move(faces));
  Vec3 low = middle(surface, faces[0]), high = low;
  for (const std::uint32_t face : faces) {
    low = low.cwiseMin(middle(surface, face));
    high = high.cwiseMax(middle(surface, face));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  // By index where middles are level, so that the patches are the same on every machine.
  std::sort(faces.begin(), faces.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(middle(surface, a)[axis], a) < std::pair(middle(surface, b)[axis], b);
  });
  const auto half = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
  split(surface, Faces(faces.begin(), half), out);
  split(surface, Faces(half, faces.end()), out);
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

SelfMesh::SelfMesh(const ContactSurface& surface) {
  find_edges(surface);
  measure(surface);
  find_parts(surface);
  find_patches(surface);
  line_up(surface);
}

void SelfMesh::find_edges(const ContactSurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  edges_of.resize(surface.triangles.size());
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = surface.triangles[f][i], b = surface.triangles[f][(i + 1) % 3];
      const auto index = static_cast<std::uint32_t>(edges.size());
      const auto [at, added] = known.try_emplace(std::minmax(a, b), index);
      if (added) edges.push_back({{std::min(a, b), std::max(a, b)}, f});
      edges_of[f][i] = at->second;
    }
}

void SelfMesh::measure(const ContactSurface& surface) {
  area.assign(surface.rest.size(), 0.0);
  longest.assign(surface.rest.size(), 0.0);
  face_of.assign(surface.rest.size(), 0);
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    const auto& corner = surface.triangles[f];
    const Vec3 &a = surface.rest[corner[0]], &b = surface.rest[corner[1]], &c = surface.rest[corner[2]];
    const double side = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double third = (b - a).cross(c - a).norm() / 6.0;
    face_longest.push_back(side);
    for (std::size_t i = 0; i < 3; ++i) {
      area[corner[i]] += third;
      face_of[corner[i]] = f;
      longest[corner[i]] = std::max(longest[corner[i]], side);
      SelfEdge& edge = edges[edges_of[f][i]];
      edge.area += third;
      edge.longest = std::max(edge.longest, side);
    }
  }
}

/// By edges, not by places: what two leaves have at one place does not hold them together.
void SelfMesh::find_parts(const ContactSurface& surface) {
  part.resize(surface.rest.size());
  std::iota(part.begin(), part.end(), 0U);
  for (const SelfEdge& edge : edges) {
    const std::uint32_t a = root(part, edge.end[0]), b = root(part, edge.end[1]);
    part[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t i = 0; i < part.size(); ++i) part[i] = root(part, i);
}

void SelfMesh::find_patches(const ContactSurface& surface) {
  SpanList list(*surface.points, spans, kParts);
  std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, Faces> groups;
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    std::vector<std::uint32_t> of;
    for (const std::uint32_t corner : surface.triangles[f]) list.of(corner, of);
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    groups[{part[surface.triangles[f][0]], std::move(of)}].push_back(f);
  }
  bound_to.resize(spans.size());
  for (std::uint32_t v = 0; v < surface.rest.size(); ++v) {
    if (area[v] == 0.0 && longest[v] == 0.0) continue;
    std::vector<std::uint32_t> of;
    list.of(v, of);
    for (const std::uint32_t span : of) bound_to[span].push_back(v);
  }
  // A vertex and an edge are of one patch alone, that no pair is looked at twice.
  std::vector<char> vertex_taken(surface.rest.size(), 0), edge_taken(edges.size(), 0);
  for (const auto& [key, faces] : groups) {
    std::vector<Faces> parts;
    split(surface, faces, parts);
    for (Faces& some : parts) {
      SelfPatch patch{std::move(some), {}, {}, {}, key.second, key.first};
      for (const std::uint32_t f : patch.faces)
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint32_t v = surface.triangles[f][i], e = edges_of[f][i];
          patch.corners.push_back(v);
          if (!std::exchange(vertex_taken[v], 1)) patch.vertices.push_back(v);
          if (!std::exchange(edge_taken[e], 1)) patch.edges.push_back(e);
        }
      std::sort(patch.corners.begin(), patch.corners.end());
      patch.corners.erase(std::unique(patch.corners.begin(), patch.corners.end()), patch.corners.end());
      patches.push_back(std::move(patch));
    }
  }
}

void SelfMesh::line_up(const ContactSurface& surface) {
  std::vector<std::uint32_t> of_part;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    const SelfPatch& patch = patches[p];
    if (p == 0 || patch.part != patches[p - 1].part) part_begin.push_back(p);
    of_part.insert(of_part.end(), patch.corners.begin(), patch.corners.end());
    if (p + 1 == patches.size() || patch.part != patches[p + 1].part) {
      std::sort(of_part.begin(), of_part.end());
      of_part.erase(std::unique(of_part.begin(), of_part.end()), of_part.end());
      corners_of_parts.add(std::exchange(of_part, {}));
    }
    corners_of_patches.add(patch.corners);
    spans_begin.push_back(static_cast<std::uint32_t>(spans_of.size()));
    spans_of.insert(spans_of.end(), patch.spans.begin(), patch.spans.end());
    amidst.push_back(surface.triangles[patch.faces[patch.faces.size() / 2]]);
  }
  spans_begin.push_back(static_cast<std::uint32_t>(spans_of.size()));
  part_begin.push_back(static_cast<std::uint32_t>(patches.size()));
}

void VertexSets::add(const std::vector<std::uint32_t>& set) {
  vertices.insert(vertices.end(), set.begin(), set.end());
  while (vertices.size() % kLane != 0) vertices.push_back(set.back());
  begin.push_back(static_cast<std::uint32_t>(vertices.size()));
}

}  // namespace tendril::contact
