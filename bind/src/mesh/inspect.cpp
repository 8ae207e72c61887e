#include <tendril/bind/inspect.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "closed_parts.h"
#include "disjoint_sets.h"

namespace tendril::bind {
namespace {

using Ids = std::vector<std::uint32_t>;

Ids all_ids(std::size_t count) {
  Ids ids(count);
  std::iota(ids.begin(), ids.end(), 0U);
  return ids;
}

// ---- points and faces one by one

/// Sorts ids by `less`, then reports each id that equals its predecessors with the first of them.
template <class Less>
std::vector<Duplicate> find_duplicates(std::size_t count, Less less) {
  Ids order = all_ids(count);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return less(a, b) || (!less(b, a) && a < b); });
  std::vector<Duplicate> duplicates;
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || less(first, order[i])) {
      first = order[i];
    } else {
      duplicates.push_back({order[i], first});
    }
  }
  std::sort(duplicates.begin(), duplicates.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return duplicates;
}

std::vector<Duplicate> duplicate_points(const PolygonMesh& mesh) {
  return find_duplicates(mesh.points.size(), [&mesh](std::uint32_t a, std::uint32_t b) {
    const Vec3& p = mesh.points[a];
    const Vec3& q = mesh.points[b];
    return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z());
  });
}

/// Each face's corners in ascending order.
Ids sorted_corners(const PolygonMesh& mesh) {
  Ids corners = mesh.corners;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::sort(corners.begin() + mesh.face_begin[f], corners.begin() + mesh.face_begin[f + 1]);
  }
  return corners;
}

std::vector<Duplicate> duplicate_faces(const PolygonMesh& mesh, const Ids& sorted) {
  const auto begin = [&](std::uint32_t f) { return sorted.begin() + mesh.face_begin[f]; };
  return find_duplicates(mesh.face_count(), [begin](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(begin(a), begin(a + 1), begin(b), begin(b + 1));
  });
}

bool has_area(const PolygonMesh& mesh, std::size_t f) {
  const auto face = mesh.face(f);
  Vec3 low = mesh.points[face[0]], high = low;
  for (const std::uint32_t corner : face) {
    low = low.cwiseMin(mesh.points[corner]);
    high = high.cwiseMax(mesh.points[corner]);
  }
  // Halved first and scaled to 1, so that neither huge nor tiny coordinates leave the range of double.
  const double half_size = (0.5 * high - 0.5 * low).maxCoeff();
  if (!(half_size > 0)) return false;
  const auto scaled = [&](std::uint32_t corner) -> Vec3 {
    return (0.5 * mesh.points[corner] - 0.5 * mesh.points[face[0]]) / half_size;
  };
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < face.size(); ++k) area += scaled(face[k]).cross(scaled(face[k + 1]));
  return area.norm() > 1e-14;
}

Ids degenerate_faces(const PolygonMesh& mesh, const Ids& sorted) {
  Ids faces;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto end = sorted.begin() + mesh.face_begin[f + 1];
    const bool repeated = std::adjacent_find(sorted.begin() + mesh.face_begin[f], end) != end;
    if (repeated || !has_area(mesh, f)) faces.push_back(f);
  }
  return faces;
}

Ids isolated_points(const PolygonMesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const std::uint32_t corner : mesh.corners) used[corner] = 1;
  Ids points;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) points.push_back(v);
  }
  return points;
}

std::size_t count_components(const PolygonMesh& mesh, std::size_t isolated) {
  DisjointSets sets(mesh.points.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (const std::uint32_t corner : face) sets.join(face[0], corner);
  }
  std::size_t roots = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) roots += sets.is_root(v);
  return roots - isolated;
}

// ---- edges

/// One use of an edge by a face: from the corner at position `from` to the next corner of the face, at `to`.
struct EdgeUse {
  Edge edge;
  std::uint32_t from, to;
};

std::vector<EdgeUse> sorted_uses(const PolygonMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(mesh.corners.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
    for (std::uint32_t c = begin; c < end; ++c) {
      const std::uint32_t next = c + 1 < end ? c + 1 : begin;
      const auto [low, high] = std::minmax(mesh.corners[c], mesh.corners[next]);
      if (low != high) uses.push_back({{low, high}, c, next});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.edge, a.from) < std::tie(b.edge, b.from);
  });
  return uses;
}

/// Calls visit(span of uses) for each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
    visit(std::span(uses).subspan(begin, end - begin));
    begin = end;
  }
}

/// The corners of `use` at the edge's two points, the smaller point's first.
Edge corners_at(const PolygonMesh& mesh, const EdgeUse& use) {
  return mesh.corners[use.from] == use.edge[0] ? Edge{use.from, use.to} : Edge{use.to, use.from};
}

/// Joins the corners of a face that repeat a point right after itself: there is no edge between them.
void join_repeats(const PolygonMesh& mesh, DisjointSets& fans) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::uint32_t begin = mesh.face_begin[f], last = mesh.face_begin[f + 1] - 1;
    for (std::uint32_t c = begin; c < last; ++c) {
      if (mesh.corners[c] == mesh.corners[c + 1]) fans.join(c, c + 1);
    }
    if (mesh.corners[last] == mesh.corners[begin]) fans.join(last, begin);
  }
}

/// Corners at one point, joined over the edges that are used exactly twice.
DisjointSets find_fans(const PolygonMesh& mesh, const std::vector<EdgeUse>& uses) {
  DisjointSets fans(mesh.corners.size());
  join_repeats(mesh, fans);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) return;
    const Edge a = corners_at(mesh, edge[0]), b = corners_at(mesh, edge[1]);
    fans.join(a[0], b[0]);
    fans.join(a[1], b[1]);
  });
  return fans;
}

Ids points_of_many_fans(const PolygonMesh& mesh, const DisjointSets& fans) {
  Ids count(mesh.points.size(), 0), points;
  for (std::uint32_t c = 0; c < mesh.corners.size(); ++c) count[mesh.corners[c]] += fans.is_root(c);
  for (std::uint32_t v = 0; v < count.size(); ++v) {
    if (count[v] > 1) points.push_back(v);
  }
  return points;
}

/// A boundary edge runs on along the fan at either end: the loops are the sets of fans that boundary edges
/// join.
std::size_t count_loops(const std::vector<EdgeUse>& uses, DisjointSets& fans, std::size_t corners) {
  DisjointSets loops(corners);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) loops.join(fans.root(edge[0].from), fans.root(edge[0].to));
  });
  std::vector<char> seen(corners, 0);
  std::size_t count = 0;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 1) return;
    char& loop = seen[loops.root(fans.root(edge[0].from))];
    count += loop == 0;
    loop = 1;
  });
  return count;
}

void report_edges(const PolygonMesh& mesh, MeshReport& report) {
  const std::vector<EdgeUse> uses = sorted_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    ++report.edges;
    if (edge.size() == 1) ++report.boundary_edges;
    if (edge.size() > 2) report.non_manifold_edges.push_back(edge[0].edge);
    if (edge.size() == 2 && mesh.corners[edge[0].from] == mesh.corners[edge[1].from]) {
      report.inconsistent_edges.push_back(edge[0].edge);
    }
  });
  DisjointSets fans = find_fans(mesh, uses);
  report.non_manifold_points = points_of_many_fans(mesh, fans);
  report.boundary_loops = count_loops(uses, fans, mesh.corners.size());
}

std::size_t count_inside_out(const PolygonMesh& mesh) {
  std::size_t count = 0;
  for (const auto& part : parts_of(mesh)) {
    const ClosedPart closed(mesh, part);
    count += closed.is_closed() && closed.volume() < 0.0 && !nested(mesh, part);
  }
  return count;
}

void report_sizes(const PolygonMesh& mesh, MeshReport& report) {
  report.points = mesh.points.size();
  report.faces = mesh.face_count();
  for (std::size_t f = 0; f < report.faces; ++f) {
    const std::size_t degree = mesh.face(f).size();
    report.triangles += degree == 3;
    report.largest_degree = std::max(report.largest_degree, degree);
  }
  if (mesh.points.empty()) return;
  report.low = report.high = mesh.points.front();
  for (const Vec3& p : mesh.points) {
    report.low = report.low.cwiseMin(p);
    report.high = report.high.cwiseMax(p);
  }
}

}  // namespace

MeshReport inspect(const PolygonMesh& mesh) {
  require_valid(mesh);
  MeshReport report;
  report_sizes(mesh, report);
  report.duplicate_points = duplicate_points(mesh);
  report.isolated_points = isolated_points(mesh);
  const Ids sorted = sorted_corners(mesh);
  report.degenerate_faces = degenerate_faces(mesh, sorted);
  report.duplicate_faces = duplicate_faces(mesh, sorted);
  report.components = count_components(mesh, report.isolated_points.size());
  report_edges(mesh, report);
  report.inside_out = count_inside_out(mesh);
  report.euler_characteristic = static_cast<std::int64_t>(report.points - report.isolated_points.size()) -
                                static_cast<std::int64_t>(report.edges) +
                                static_cast<std::int64_t>(report.faces);
  return report;
}

}  // namespace tendril::bind
