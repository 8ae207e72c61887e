#include "prepare.h"

#include <tendril/base/error.h>
#include <tendril/bind/inspect.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

#include "mesh/disjoint_sets.h"

namespace tendril::axis {
namespace {

using bind::PolygonMesh;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kGrid = 0x1p-30;   ///< of the diagonal
constexpr double kCoarse = 64.0;    ///< so many times as high are all triangles that are put on it
constexpr double kLargest = 1e100;  // distances are squared, and areas of them

struct Soup {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;
};

/// Pairs of points that some face has an edge or a diagonal between.
using Pairs = std::set<std::array<std::uint32_t, 2>>;

std::array<std::uint32_t, 2> pair_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Whether the diagonals from corner `apex` of a polygon are edges of nothing yet.
bool may_fan_from(std::span<const std::uint32_t> face, std::size_t apex, const Pairs& taken) {
  for (std::size_t k = 2; k + 1 < face.size(); ++k)
    if (taken.contains(pair_of(face[apex], face[(apex + k) % face.size()]))) return false;
  return true;
}

void fan_from(std::span<const std::uint32_t> face, std::size_t apex, Pairs& taken, Soup& out) {
  const std::size_t n = face.size();
  for (std::size_t k = 2; k < n; ++k) {
    out.faces.push_back({face[apex], face[(apex + k - 1) % n], face[(apex + k) % n]});
    if (k + 1 < n) taken.insert(pair_of(face[apex], face[(apex + k) % n]));
  }
}

void fan_about_middle(std::span<const std::uint32_t> face, Soup& out) {
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : face) middle += out.points[i] / static_cast<double>(face.size());
  const auto centre = static_cast<std::uint32_t>(out.points.size());
  out.points.push_back(middle);
  for (std::size_t k = 0; k < face.size(); ++k)
    out.faces.push_back({face[k], face[(k + 1) % face.size()], centre});
}

/// Triangles in place of polygons, each a fan from its first corner whose diagonals are edges of nothing else
/// (two quads about a point of valence 2 share three points: the same diagonal in both would be an edge of
/// four triangles), or else about a point in its middle.
Soup fans(const PolygonMesh& mesh) {
  Soup out{mesh.points, {}};
  Pairs taken;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    if (mesh.corners.size() == 3 * mesh.face_count()) break;  // triangles have no diagonals
    for (std::size_t k = 0; k < face.size(); ++k) taken.insert(pair_of(face[k], face[(k + 1) % face.size()]));
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    std::size_t apex = 0;
    while (apex < face.size() && !may_fan_from(face, apex, taken)) ++apex;
    if (apex < face.size())
      fan_from(face, apex, taken, out);
    else
      fan_about_middle(face, out);
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

/// What a closed surface encloses; negative where its faces look inward. About its first point.
double volume_of(const Soup& soup) {
  double six = 0.0;
  for (const auto& [a, b, c] : soup.faces) {
    const Vec3& origin = soup.points[soup.faces[0][0]];
    six += (soup.points[a] - origin).dot((soup.points[b] - origin).cross(soup.points[c] - origin));
  }
  return six / 6.0;
}

double area_of(const Soup& soup) {
  double twice = 0.0;
  for (const auto& [a, b, c] : soup.faces)
    twice += (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]).norm();
  return 0.5 * twice;
}

/// Turns a surface that is inside out. Refuses one that is flat: there is no middle to be found.
/// \return  whether it was turned
bool orient_outward(Soup& soup) {
  constexpr double kFlat = 1e-6;  // of the volume over that of a cube of the same area
  const double volume = volume_of(soup), area = area_of(soup);
  if (!(std::abs(volume) > kFlat * area * std::sqrt(area)))
    throw InvalidInput("mesh", "flat: a surface that encloses no volume", "a closed surface round a body");
  if (volume > 0.0) return false;
  for (Triangle& face : soup.faces) std::swap(face[1], face[2]);
  return true;
}

/// Middles of edges, one for both triangles there.
class Middles {
 public:
  explicit Middles(Soup& soup) : soup_(soup) {}
  std::uint32_t at(std::uint32_t a, std::uint32_t b) {
    const auto [entry, made] =
        middles_.try_emplace(pair_of(a, b), static_cast<std::uint32_t>(soup_.points.size()));
    if (made) soup_.points.push_back(0.5 * (soup_.points[a] + soup_.points[b]));
    return entry->second;
  }

 private:
  Soup& soup_;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles_;
};

/// Splits a triangle at the middles of those of its edges that are longer than `most`.
void split_long_edges(const Triangle& face, double most, Middles& middles, const Soup& soup,
                      std::vector<Triangle>& to) {
  const auto length = [&](std::size_t k) {
    return (soup.points[face[(k + 1) % 3]] - soup.points[face[k]]).norm();
  };
  std::size_t longest = 0;
  for (const std::size_t k : {1U, 2U})
    if (length(k) > length(longest)) longest = k;
  if (length(longest) <= most) return to.push_back(face);
  // The longest edge is that from a to b; of the others, those that are long too.
  const std::uint32_t a = face[longest], b = face[(longest + 1) % 3], c = face[(longest + 2) % 3];
  const bool far_bc = length((longest + 1) % 3) > most, far_ca = length((longest + 2) % 3) > most;
  const std::uint32_t ab = middles.at(a, b);
  const auto half = [&](std::uint32_t p, std::uint32_t q, std::uint32_t apex, bool far) {
    // The triangle p q apex, its edge q apex split where it is long.
    if (!far) return to.push_back({p, q, apex});
    const std::uint32_t middle = middles.at(q, apex);
    to.insert(to.end(), {{p, q, middle}, {p, middle, apex}});
  };
  half(ab, b, c, far_bc);
  if (!far_ca) return to.push_back({ab, c, a});
  const std::uint32_t ca = middles.at(c, a);
  to.insert(to.end(), {{ab, c, ca}, {ab, ca, a}});
}

/// Needles (a cylinder with points on its lids only) leave the contraction nothing to move along their way:
/// edges much longer than the points asked for would stand apart are halved until none is left.
void split_needles(Soup& soup, std::size_t points) {
  constexpr double kApart = 4.0, kSlender = 8.0, kMostPieces = 25.0;
  const double most =
      kApart * std::sqrt(area_of(soup) / static_cast<double>(std::max<std::size_t>(points, 1)));
  const auto longest = [&](const Triangle& face) {
    const Vec3 &a = soup.points[face[0]], &b = soup.points[face[1]], &c = soup.points[face[2]];
    return std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
  };
  const auto is_needle = [&](const Triangle& face) {
    const Vec3 x = soup.points[face[1]] - soup.points[face[0]],
               y = soup.points[face[2]] - soup.points[face[0]];
    const double length = longest(face);
    return length > most && length * length > kSlender * x.cross(y).norm();
  };
  double pieces = 0.0;
  for (const Triangle& face : soup.faces)
    if (is_needle(face)) pieces += 2.0 * longest(face) / most;
  if (!(pieces < kMostPieces * static_cast<double>(points)))
    throw InvalidInput("mesh", "triangles thousands of times as long as the surface is wide",
                       "none that would take many times the points of others to find an axis in");
  // Halved a hundred times, any edge is shorter than the spacing of its numbers.
  for (int pass = 0; pass < 100 && std::any_of(soup.faces.begin(), soup.faces.end(), is_needle); ++pass) {
    std::vector<Triangle> faces;
    Middles middles(soup);
    const std::vector<Triangle> before = std::move(soup.faces);
    for (const Triangle& face : before) split_long_edges(face, most, middles, soup, faces);
    soup.faces = std::move(faces);
  }
}

/// Every triangle in four.
void split_in_four(Soup& soup) {
  Middles middles(soup);
  std::vector<Triangle> faces;
  for (const auto& [a, b, c] : soup.faces) {
    const std::uint32_t ab = middles.at(a, b), bc = middles.at(b, c), ca = middles.at(c, a);
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
  return {0.5 * low + 0.5 * high, (high - low).norm()};
}

double least_altitude(const Soup& soup) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : soup.faces) {
    const Vec3 x = soup.points[b] - soup.points[a], y = soup.points[c] - soup.points[a];
    least = std::min(least, x.cross(y).norm() / std::max({x.norm(), y.norm(), (y - x).norm()}));
  }
  return least;
}

/// To a diagonal of 1, and to multiples of kGrid: what the contraction collapses feels the last bit, so that
/// the axes of one mesh were others in millimetres, or elsewhere. Not where triangles are as fine as that.
UnitScaling scale_to_unit(Soup& soup) {
  const UnitScaling scaling = scaling_of(soup.points);
  for (Vec3& p : soup.points) p = (p - scaling.centre) / scaling.scale;
  if (least_altitude(soup) > kCoarse * kGrid)
    for (Vec3& p : soup.points) p = kGrid * (p / kGrid).array().round();
  return scaling;
}

}  // namespace

Prepared prepare(const PolygonMesh& mesh, const AxisOptions& options, AxisReport& report) {
  bind::require_valid(mesh);
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (!(mesh.points[i].cwiseAbs().maxCoeff() <= kLargest))
      throw InvalidInput("points[" + std::to_string(i) + "]", "beyond 1e100", "smaller coordinates");
  Soup soup = fans(mesh);
  // Before the parts are told apart: a point may be all that joins two.
  if (options.largest_part || options.close) report.split_points = split_points(soup);
  if (options.largest_part) report.left_out_parts = keep_largest_part(soup);
  drop_isolated_points(soup);
  if (options.close) report.closed_holes = close_holes(soup);
  require_fit(to_mesh(soup));
  report.turned = orient_outward(soup);
  const UnitScaling scaling = scale_to_unit(soup);
  split_needles(soup, options.least_points);
  for (; soup.points.size() < options.least_points; ++report.splits) split_in_four(soup);
  return {to_mesh(std::move(soup)), scaling};
}

}  // namespace tendril::axis
