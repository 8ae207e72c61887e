#include "closed_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "disjoint_sets.h"

namespace tendril::bind {
namespace {

struct DirectedEdge {
  Edge edge;
  std::uint32_t face;
  bool forward;
};

std::vector<DirectedEdge> sorted_edges(const PolygonMesh& mesh, std::span<const ClosedPart::Face> faces) {
  std::vector<DirectedEdge> edges;
  for (const ClosedPart::Face& f : faces) {
    const auto face = mesh.face(f.id);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (a != b) edges.push_back({{std::min(a, b), std::max(a, b)}, f.id, (a < b) != f.turned});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const DirectedEdge& a, const DirectedEdge& b) { return a.edge < b.edge; });
  return edges;
}

/// Calls visit(span of uses) for each edge.
template <class Visit>
void for_each_edge(const std::vector<DirectedEdge>& edges, Visit visit) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].edge == edges[i].edge) ++end;
    visit(std::span(edges).subspan(i, end - i));
    i = end;
  }
}

/// Solid angle of a triangle (van Oosterom and Strackee 1983), its corners as seen from the point.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double down = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), down);
}

// A part is closed when it has no boundary as a chain: each edge is run through as often one way as the
// other. (An edge of four faces, where two parts touch, is no hole.) By the divergence theorem the tetrahedra
// that fans of its faces form with any point then have the volume it encloses as their signed sum, the
// point's own part cancelling; the part's own corner keeps them small. The solid angles of all other faces,
// as seen from a point of the part, sum to 4 pi times how often they wind round it: 0 outside, 4 pi within.

}  // namespace

ClosedPart::ClosedPart(const PolygonMesh& mesh, std::span<const Face> faces) {
  closed_ = !faces.empty();
  for_each_edge(sorted_edges(mesh, faces), [&](std::span<const DirectedEdge> uses) {
    const auto forward = std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.forward; });
    closed_ &= 2 * static_cast<std::size_t>(forward) == uses.size();
  });
  if (!closed_) return;
  const Vec3 half = 0.5 * mesh.points[mesh.face(faces.front().id)[0]];  // halved: nothing overflows
  double size = 0.0;
  for (const Face& f : faces)
    for (const std::uint32_t i : mesh.face(f.id))
      size = std::max(size, (0.5 * mesh.points[i] - half).cwiseAbs().maxCoeff());
  if (!(size > 0.0)) return;
  const auto at = [&](std::uint32_t i) -> Vec3 { return (0.5 * mesh.points[i] - half) / size; };
  for (const Face& f : faces) {
    const auto face = mesh.face(f.id);
    double six = 0.0;
    for (std::size_t k = 2; k < face.size(); ++k) six += at(face[0]).dot(at(face[k - 1]).cross(at(face[k])));
    volume_ += f.turned ? -six : six;
  }
}

namespace {

/// Of a polygon as a fan, seen from a point.
double angle_of(const PolygonMesh& mesh, std::size_t f, const Vec3& p) {
  const auto face = mesh.face(f);
  double angle = 0.0;
  for (std::size_t k = 2; k < face.size(); ++k)
    angle += solid_angle(mesh.points[face[0]] - p, mesh.points[face[k - 1]] - p, mesh.points[face[k]] - p);
  return angle;
}

bool goes_round(double angle) {
  return std::abs(angle) > 2.0 * std::numbers::pi;  // half of a full turn round
}

}  // namespace

bool within(const PolygonMesh& mesh, std::span<const std::uint32_t> part,
            std::span<const std::uint32_t> other) {
  const Vec3 p = mesh.points[mesh.face(part.front())[0]];
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::uint32_t f : other)
    for (const std::uint32_t i : mesh.face(f)) {
      low = low.cwiseMin(mesh.points[i]);
      high = high.cwiseMax(mesh.points[i]);
    }
  if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) return false;
  double angle = 0.0;
  for (const std::uint32_t f : other) angle += angle_of(mesh, f, p);
  return goes_round(angle);
}

bool nested(const PolygonMesh& mesh, std::span<const ClosedPart::Face> part) {
  std::vector<char> own(mesh.face_count(), 0);
  for (const ClosedPart::Face& f : part) own[f.id] = 1;
  const Vec3 p = mesh.points[mesh.face(part.front().id)[0]];
  double angle = 0.0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!own[f]) angle += angle_of(mesh, f, p);
  }
  return goes_round(angle);
}

std::vector<std::vector<ClosedPart::Face>> parts_of(const PolygonMesh& mesh) {
  std::vector<ClosedPart::Face> all(mesh.face_count());
  for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = {f, false};
  DisjointSets sets(mesh.face_count());
  for_each_edge(sorted_edges(mesh, all), [&](std::span<const DirectedEdge> uses) {
    if (uses.size() == 2) sets.join(uses[0].face, uses[1].face);
  });
  std::vector<std::vector<ClosedPart::Face>> of_root(mesh.face_count()), parts;
  for (const ClosedPart::Face& f : all) of_root[sets.root(f.id)].push_back(f);
  for (auto& part : of_root)
    if (!part.empty()) parts.push_back(std::move(part));
  return parts;
}

}  // namespace tendril::bind
