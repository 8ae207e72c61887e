#include <tendril/base/error.h>
#include <tendril/bind/judge.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril::bind {
namespace {

using Pair = std::array<std::uint32_t, 2>;

/// Edges of a triangle mesh, each once, ascending.
std::vector<Pair> edges_of(const PolygonMesh& mesh) {
  std::vector<Pair> edges;
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
  return edges;
}

PolygonMesh triangles_of(const PolygonMesh& mesh) {
  PolygonMesh out;
  out.points = mesh.points;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) {
      out.corners.insert(out.corners.end(), {face[0], face[k - 1], face[k]});
      out.face_begin.push_back(static_cast<std::uint32_t>(out.corners.size()));
    }
  }
  return out;
}

Vec3 area(Points points, std::span<const std::uint32_t> face) {
  return (points[face[1]] - points[face[0]]).cross(points[face[2]] - points[face[0]]);
}

/// v from the frame at rest to the posed one.
Vec3 carried(const Frame& rest, const Frame& posed, const Vec3& v) {
  return rest.x.dot(v) * posed.x + rest.y.dot(v) * posed.y + rest.z.dot(v) * posed.z;
}

/// Smallest value that at least this share of the sorted values does not exceed.
double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

double ratio(double now, double before) {
  return before > 0.0 ? now / before : now > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

void check(const JudgeOptions& options) {
  if (options.refinements < 1 || options.refinements > 4)
    throw InvalidInput("refinements", std::to_string(options.refinements), "1 to 4");
  if (!(options.limit > 0.0)) throw InvalidInput("limit", std::to_string(options.limit), "above 0");
}

}  // namespace

PolygonMesh split_at_middles(const PolygonMesh& mesh) {
  const PolygonMesh triangles = triangles_of(mesh);
  const std::vector<Pair> edges = edges_of(triangles);
  PolygonMesh out;
  out.points = mesh.points;
  for (const Pair& edge : edges) out.points.push_back(0.5 * (mesh.points[edge[0]] + mesh.points[edge[1]]));
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    if (a == b) return a;
    const Pair edge{std::min(a, b), std::max(a, b)};
    const auto at = std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin();
    return static_cast<std::uint32_t>(mesh.points.size() + static_cast<std::size_t>(at));
  };
  for (std::size_t f = 0; f < triangles.face_count(); ++f) {
    const auto face = triangles.face(f);
    const std::uint32_t a = face[0], b = face[1], c = face[2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.corners.insert(out.corners.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    for (int k = 0; k < 4; ++k) out.face_begin.push_back(out.face_begin.back() + 3);
  }
  return out;
}

struct TearJudge::Level {
  PolygonMesh mesh;
  std::vector<Pair> edges;
  Binding binding;

  Level(PolygonMesh m, std::span<const CurvePair> rest, const BindOptions& bind)
      : mesh(std::move(m)), edges(edges_of(mesh)), binding(rest, mesh, bind) {}

  std::size_t flipped(std::span<const CurvePair> rest, std::span<const CurvePair> posed,
                      Points points) const {
    std::size_t count = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(f);
      const std::size_t pair = binding.pair_of(face[0]);
      const double t = binding.records()[face[0]].t;
      const Vec3 expected =
          carried(rest[pair].frame(t).frame, posed[pair].frame(t).frame, area(mesh.points, face));
      count += area(points, face).dot(expected) < 0.0;
    }
    return count;
  }
};

TearJudge::TearJudge(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& bind,
                     const JudgeOptions& options)
    : rest_(rest.begin(), rest.end()), options_(options), threads_(bind.threads) {
  check(options);
  require_valid(mesh);
  PolygonMesh now = triangles_of(mesh);
  if (now.corners.empty()) throw InvalidInput("mesh", "no faces", "a mesh with edges");
  while (edges_of(now).size() < options.least_edges) now = split_at_middles(now);
  for (int k = 0; k <= options.refinements; ++k) {
    if (k > 0) now = split_at_middles(now);
    levels_.emplace_back(now, rest_, bind);
  }
}

TearJudge::~TearJudge() = default;

const PolygonMesh& TearJudge::mesh() const {
  return levels_.front().mesh;
}

const Binding& TearJudge::binding() const {
  return levels_.front().binding;
}

JudgeReport TearJudge::judge(std::span<const CurvePair> posed) const {
  JudgeReport report;
  for (const Level& level : levels_) {
    std::vector<Vec3> points(level.mesh.points.size());
    level.binding.update(posed, points, threads_);
    std::vector<WorstEdge> edges;
    for (const Pair& edge : level.edges) {
      const double rest = (level.mesh.points[edge[0]] - level.mesh.points[edge[1]]).norm();
      if (rest > 0.0) edges.push_back({edge[0], edge[1], (points[edge[0]] - points[edge[1]]).norm() / rest});
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const WorstEdge& a, const WorstEdge& b) { return a.stretch > b.stretch; });
    std::vector<double> stretch(edges.size());
    std::transform(edges.rbegin(), edges.rend(), stretch.begin(),
                   [](const WorstEdge& e) { return e.stretch; });
    if (report.levels.empty())
      report.worst.assign(
          edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(std::min(options_.worst, edges.size())));
    JudgeLevel& now = report.levels.emplace_back();
    now = {points.size(), edges.size(), level.mesh.face_count()};
    for (std::size_t q = 0; q < kJudgeShares.size(); ++q)
      now.quantile[q] = quantile(stretch, kJudgeShares[q]);
    now.max = stretch.empty() ? 0.0 : stretch.back();
    now.beyond = static_cast<std::size_t>(stretch.end() -
                                          std::upper_bound(stretch.begin(), stretch.end(), options_.limit));
    now.flipped = level.flipped(rest_, posed, points);
    now.rest_error = level.binding.report().rest_error;
    now.ambiguous = level.binding.report().ambiguous.size();
  }
  conclude(report);
  return report;
}

// Why stretch is judged by its growth from one mesh to its refinement. Where the binding is smooth, an edge
// half as long is stretched as much as before, and quantiles settle. Across a tear two neighbours go apart by
// a distance that does not shrink with the edge, so its stretch doubles; the edges that cross a tear along a
// line double in number too, while all edges grow fourfold, hence the exponent 1 of their count (2 for
// stretch all over a surface, 0 at points).
void TearJudge::conclude(JudgeReport& report) const {
  for (std::size_t k = 1; k < report.levels.size(); ++k) {
    const JudgeLevel &before = report.levels[k - 1], &now = report.levels[k];
    for (std::size_t q = 0; q < kJudgeShares.size(); ++q)
      report.growth[q] = std::max(report.growth[q], ratio(now.quantile[q], before.quantile[q]));
    report.growth_of_max = std::max(report.growth_of_max, ratio(now.max, before.max));
    report.exponent = now.beyond == 0
                          ? 0.0
                          : std::log2(static_cast<double>(now.beyond) /
                                      static_cast<double>(std::max<std::size_t>(before.beyond, 1)));
  }
  const bool steady = *std::max_element(report.growth.begin(), report.growth.end()) <= options_.most_growth;
  report.verdict =
      steady && report.growth_of_max <= options_.most_growth_of_max ? TearVerdict::smooth : TearVerdict::tear;
}

}  // namespace tendril::bind
