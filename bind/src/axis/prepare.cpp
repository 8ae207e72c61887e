#include "prepare.h"

#include <tendril/base/error.h>
#include <tendril/bind/inspect.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/disjoint_sets.h"

namespace tendril::axis {
namespace {

using bind::PolygonMesh;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kLargest = 1e100;  // distances are squared, and areas of them

struct Soup {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;
};

Soup fans(const PolygonMesh& mesh) {
  Soup out{mesh.points, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) out.faces.push_back({face[0], face[k - 1], face[k]});
  }
  return out;
}

PolygonMesh to_mesh(Soup soup) {
  PolygonMesh out;
  out.points = std::move(soup.points);
  for (const Triangle& face : soup.faces) {
    out.corners.insert(out.corners.end(), face.begin(), face.end());
    out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
  }
  return out;
}

void drop_isolated_points(Soup& soup) {
  std::vector<std::uint32_t> number(soup.points.size(), 0);
  for (const Triangle& face : soup.faces)
    for (const std::uint32_t i : face) number[i] = 1;
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(soup.points[i]);
  }
  soup.points = std::move(kept);
  for (Triangle& face : soup.faces)
    for (std::uint32_t& i : face) i = number[i];
}

/// Leaves the faces joined by points that have the largest area together.
/// \return  number of other parts
std::size_t keep_largest_part(Soup& soup) {
  bind::DisjointSets parts(soup.points.size());
  for (const auto& [a, b, c] : soup.faces) {
    parts.join(a, b);
    parts.join(b, c);
  }
  std::map<std::uint32_t, double> area;
  for (const auto& [a, b, c] : soup.faces)
    area[parts.root(a)] += (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]).norm();
  if (area.empty()) return 0;
  const auto largest = std::max_element(area.begin(), area.end(),
                                        [](const auto& x, const auto& y) { return x.second < y.second; });
  std::erase_if(soup.faces, [&](const Triangle& face) { return parts.root(face[0]) != largest->first; });
  return area.size() - 1;
}

/// Directed edges with the corner (3 face + place) that each starts from; ascending.
struct DirectedEdge {
  std::uint32_t from, to, corner;
  friend auto operator<=>(const DirectedEdge&, const DirectedEdge&) = default;
};

std::vector<DirectedEdge> directed_edges(const Soup& soup) {
  std::vector<DirectedEdge> out;
  for (std::uint32_t f = 0; f < soup.faces.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k)
      out.push_back({soup.faces[f][k], soup.faces[f][(k + 1) % 3], 3 * f + k});
  std::sort(out.begin(), out.end());
  return out;
}

const DirectedEdge* find(const std::vector<DirectedEdge>& edges, std::uint32_t from, std::uint32_t to) {
  const auto found = std::lower_bound(edges.begin(), edges.end(), DirectedEdge{from, to, 0});
  return found != edges.end() && found->from == from && found->to == to ? &*found : nullptr;
}

/// A point for each fan of faces joined by edges.
/// \return  number of points that had several
std::size_t split_points(Soup& soup) {
  const std::vector<DirectedEdge> edges = directed_edges(soup);
  bind::DisjointSets fans(3 * soup.faces.size());
  const auto next = [](std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  for (const DirectedEdge& e : edges) {
    const DirectedEdge* other = find(edges, e.to, e.from);
    if (other == nullptr) continue;
    fans.join(e.corner, next(other->corner));
    fans.join(next(e.corner), other->corner);
  }
  std::vector<std::uint32_t> first(soup.points.size(), 0xffffffff);
  std::map<std::uint32_t, std::uint32_t> copy;
  std::vector<bool> split(soup.points.size(), false);
  for (std::uint32_t corner = 0; corner < 3 * soup.faces.size(); ++corner) {
    std::uint32_t& point = soup.faces[corner / 3][corner % 3];
    const std::uint32_t fan = fans.root(corner);
    if (first[point] == 0xffffffff) first[point] = fan;
    if (first[point] == fan) continue;
    split[point] = true;
    const auto [entry, made] = copy.try_emplace(fan, static_cast<std::uint32_t>(soup.points.size()));
    if (made) soup.points.push_back(Vec3(soup.points[point]));
    point = entry->second;
  }
  return static_cast<std::size_t>(std::count(split.begin(), split.end(), true));
}

/// A fan about the middle of each loop of edges used once.
/// \return  number of loops
std::size_t close_holes(Soup& soup) {
  const std::vector<DirectedEdge> edges = directed_edges(soup);
  std::map<std::uint32_t, std::uint32_t> open;  // edges that the missing faces would have
  for (const DirectedEdge& e : edges)
    if (find(edges, e.to, e.from) == nullptr) open.emplace(e.to, e.from);
  std::size_t loops = 0;
  while (!open.empty()) {
    std::vector<std::uint32_t> loop;
    for (auto at = open.begin(); at != open.end(); at = open.find(loop.back())) {
      if (loop.empty()) loop.push_back(at->first);
      loop.push_back(at->second);
      open.erase(at);
    }
    if (loop.back() != loop.front()) continue;  // what is left open is refused later
    loop.pop_back();
    ++loops;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t i : loop) middle += soup.points[i] / static_cast<double>(loop.size());
    const auto centre = static_cast<std::uint32_t>(soup.points.size());
    soup.points.push_back(middle);
    for (std::size_t k = 0; k < loop.size(); ++k)
      soup.faces.push_back({loop[k], loop[(k + 1) % loop.size()], centre});
  }
  return loops;
}

void require_fit(const PolygonMesh& mesh) {
  const bind::MeshReport report = bind::inspect(mesh);
  std::string wrong;
  const auto count = [&](std::size_t n, const char* what) {
    if (n > 0) wrong += (wrong.empty() ? "" : ", ") + std::to_string(n) + ' ' + what;
  };
  if (report.faces == 0) wrong = "no faces";
  if (report.components > 1) count(report.components, "parts");
  count(report.boundary_loops, "hole(s)");
  count(report.non_manifold_edges.size(), "non-manifold edge(s)");
  count(report.non_manifold_points.size(), "non-manifold point(s)");
  count(report.inconsistent_edges.size(), "edge(s) used twice in one direction");
  count(report.degenerate_faces.size(), "triangle(s) of no area");
  if (wrong.empty() && !report.is_closed()) count(report.boundary_edges, "open edge(s)");
  if (!wrong.empty())
    throw InvalidInput(
        "mesh", wrong,
        "one closed, manifold surface; holes are closed in a copy, and the largest part is taken, "
        "when asked");
}

/// Every triangle in four.
void split_in_four(Soup& soup) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, made] =
        middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(soup.points.size()));
    if (made) soup.points.push_back(0.5 * (soup.points[a] + soup.points[b]));
    return entry->second;
  };
  std::vector<Triangle> faces;
  for (const auto& [a, b, c] : soup.faces) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    faces.insert(faces.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  soup.faces = std::move(faces);
}

UnitScaling scaling_of(Points points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {0.5 * low + 0.5 * high, std::exp2(std::ceil(std::log2((high - low).norm())))};
}

}  // namespace

Prepared prepare(const PolygonMesh& mesh, const AxisOptions& options, AxisReport& report) {
  bind::require_valid(mesh);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (!(mesh.points[i].cwiseAbs().maxCoeff() <= kLargest))
      throw InvalidInput("points[" + std::to_string(i) + "]", "beyond 1e100", "smaller coordinates");
  Soup soup = fans(mesh);
  if (options.largest_part) report.left_out_parts = keep_largest_part(soup);
  drop_isolated_points(soup);
  if (options.close) {
    report.split_points = split_points(soup);
    report.closed_holes = close_holes(soup);
  }
  require_fit(to_mesh(soup));
  for (; soup.points.size() < options.least_points; ++report.splits) split_in_four(soup);
  const UnitScaling scaling = scaling_of(soup.points);
  for (Vec3& p : soup.points) p = (p - scaling.centre) / scaling.scale;
  return {to_mesh(std::move(soup)), scaling};
}

}  // namespace tendril::axis
