#include <tendril/base/error.h>
#include <tendril/bind/judge.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <string>
#include <tuple>

#include "split.h"
#include "tears.h"

namespace tendril::bind {
namespace {

/// A half that is stretched more than this times as much as its edge is halved on.
constexpr double kUneven = 1.25;
/// Over the diagonal: that of pieces which tell a jump. Rounding is a millionth of it.
constexpr double kShortest = 1e-9;

Vec3 area(Points points, std::span<const std::uint32_t> face) {
  return (points[face[1]] - points[face[0]]).cross(points[face[2]] - points[face[0]]);
}

/// v from the frame at rest to the posed one.
Vec3 carried(const Frame& rest, const Frame& posed, const Vec3& v) {
  return rest.x.dot(v) * posed.x + rest.y.dot(v) * posed.y + rest.z.dot(v) * posed.z;
}

/// Smallest value that at least this share of the values does not exceed; puts them in another order.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(1.0, rank)) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double ratio(double now, double before) {
  return before > 0.0 ? now / before : now > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

void check(const JudgeOptions& options) {
  if (options.refinements < 1 || options.refinements > 4)
    throw InvalidInput("refinements", std::to_string(options.refinements), "1 to 4");
  if (!(options.limit > 0.0)) throw InvalidInput("limit", std::to_string(options.limit), "above 0");
  if (!(options.least_gap >= 1e-6 && options.least_gap <= 1.0))
    throw InvalidInput("least_gap", std::to_string(options.least_gap), "1e-6 to 1");
}

/// The mesh as it is judged, from the first level on.
std::vector<TriangleMesh> levels_of(const PolygonMesh& mesh, const JudgeOptions& options) {
  check(options);
  require_valid(mesh);
  TriangleMesh now(mesh);
  if (now.edges.empty()) throw InvalidInput("mesh", "no faces", "a mesh with edges");
  while (now.edges.size() < options.least_edges) now = now.split();
  std::vector<TriangleMesh> out{std::move(now)};
  for (int k = 0; k < options.refinements; ++k) out.push_back(out.back().split());
  return out;
}

/// The first `count` by `before`, and in this order. Of hundreds of thousands a few hundred are wanted.
template <class T, class Before>
void keep_first(std::vector<T>& list, std::size_t count, const Before& before) {
  const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(count, list.size()));
  std::partial_sort(list.begin(), end, list.end(), before);
  list.erase(end, list.end());
}

/// Ties by index, so that a report does not depend on how a sort happens to leave them.
bool more_stretched(const WorstEdge& a, const WorstEdge& b) {
  return a.stretch != b.stretch ? a.stretch > b.stretch : PointPair{a.a, a.b} < PointPair{b.a, b.b};
}

/// What becomes of the edges in a pose.
std::vector<WorstEdge> stretches(const TriangleMesh& level, Points posed) {
  std::vector<WorstEdge> out;
  out.reserve(level.edges.size());
  for (const auto& [a, b] : level.edges) {
    const double rest = (level.mesh.points[a] - level.mesh.points[b]).norm();
    if (rest > 0.0) out.push_back({a, b, (posed[a] - posed[b]).norm() / rest});
  }
  return out;
}

}  // namespace

/// Without splitting anything: a split puts a point on each edge, halves it, and joins the three within
/// each face.
JudgeCost judge_cost(const PolygonMesh& mesh, const JudgeOptions& options) {
  check(options);
  require_valid(mesh);
  const TriangleMesh triangles(mesh);
  JudgeCost out{mesh.points.size(), triangles.edges.size()};
  std::size_t faces = triangles.mesh.face_count();
  const auto split = [&] {
    out = {out.points + out.edges, 2 * out.edges + 3 * faces};
    faces *= 4;
  };
  while (out.edges > 0 && out.edges < options.least_edges) split();
  for (int k = 0; k < options.refinements; ++k) split();
  return out;
}

struct TearJudge::Data {
  /// Only the points that a level has and the one before has not are bound for it.
  struct Level {
    TriangleMesh triangles;
    Binding added;
  };
  /// What a point is bound to first.
  struct Nearest {
    std::uint32_t pair;
    double t;
  };

  /// One binder for all levels: what it knows of the body, its voxels and the ways through it, costs most.
  Data(std::span<const CurvePair> curves, const PolygonMesh& mesh, const BindOptions& bind,
       const JudgeOptions& asked)
      : options(asked),
        threads(bind.threads),
        diagonal(bounding_diagonal(mesh.points)),
        rest(curves.begin(), curves.end()) {
    // Beside the binder: each takes about as long.
    std::future<std::vector<TriangleMesh>> meshes =
        std::async(threads > 1 ? std::launch::async | std::launch::deferred : std::launch::deferred,
                   [&] { return levels_of(mesh, asked); });
    binder.emplace(rest, mesh, bind);
    own.emplace(binder->bind(mesh.points, {}));
    std::vector<TriangleMesh> made = meshes.get();
    const bool split = made[0].mesh.points.size() > mesh.points.size();
    Binding first = split ? binder->bind(made[0].mesh.points, own_faces(mesh, made[0])) : *own;
    add(std::move(made[0]), std::move(first));
    for (std::size_t k = 1; k < made.size(); ++k) {
      const TriangleMesh& before = levels.back().triangles;
      const Points middles = Points(made[k].mesh.points).subspan(before.mesh.points.size());
      Binding added = binder->bind(middles, before.faces_of_edges());
      add(std::move(made[k]), std::move(added));
    }
  }

  /// A face of the body for each point of the first level.
  static std::vector<std::uint32_t> own_faces(const PolygonMesh& mesh, const TriangleMesh& level);
  void add(TriangleMesh triangles, Binding added);
  std::size_t flipped(const TriangleMesh& level, std::span<const CurvePair> posed, Points points) const;
  JudgeLevel look_at(const Level& level, std::span<const CurvePair> posed, Points points,
                     std::vector<WorstEdge>& edges) const;
  std::vector<Piece> pieces(Points points) const;
  void find_tears(std::span<const CurvePair> posed, Points points, JudgeReport& report) const;

  JudgeOptions options;
  int threads;
  double diagonal;
  std::vector<CurvePair> rest;
  std::optional<SurfaceBinder> binder;  ///< once the constructor is through, as the next
  std::optional<Binding> own;
  std::vector<Level> levels;
  std::vector<Nearest> nearest;  ///< of the finest level's points
};

/// From the last face on, so that the first of a point's faces stays.
std::vector<std::uint32_t> TearJudge::Data::own_faces(const PolygonMesh& mesh, const TriangleMesh& level) {
  std::vector<std::uint32_t> out(level.mesh.points.size());
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i)  // of points in no face, see BodyGrid::place
    out[i] = static_cast<std::uint32_t>(mesh.face_count()) + i;
  for (std::size_t f = level.mesh.face_count(); f-- > 0;)
    for (const std::uint32_t corner : level.mesh.face(f)) out[corner] = level.face_of[f];
  return out;
}

void TearJudge::Data::add(TriangleMesh triangles, Binding added) {
  for (std::size_t i = 0; i < added.size(); ++i) nearest.push_back({added.pair_of(i), added.records()[i].t});
  levels.push_back({std::move(triangles), std::move(added)});
}

/// Against the normal that the frame of its first corner has carried along: a face that a limb turns over
/// is not flipped, one that is turned inside out against its limb is.
std::size_t TearJudge::Data::flipped(const TriangleMesh& level, std::span<const CurvePair> posed,
                                     Points points) const {
  std::size_t count = 0;
  for (std::size_t f = 0; f < level.mesh.face_count(); ++f) {
    const auto face = level.mesh.face(f);
    const auto [pair, t] = nearest[face[0]];
    const Vec3 expected =
        carried(rest[pair].frame(t).frame, posed[pair].frame(t).frame, area(level.mesh.points, face));
    count += area(points, face).dot(expected) < 0.0;
  }
  return count;
}

JudgeLevel TearJudge::Data::look_at(const Level& level, std::span<const CurvePair> posed, Points points,
                                    std::vector<WorstEdge>& edges) const {
  edges = stretches(level.triangles, points);
  std::vector<double> stretch(edges.size());
  std::transform(edges.begin(), edges.end(), stretch.begin(), [](const WorstEdge& e) { return e.stretch; });
  JudgeLevel now{points.size(), level.triangles.edges.size(), level.triangles.mesh.face_count()};
  for (std::size_t q = 0; q < kJudgeShares.size(); ++q) now.quantile[q] = quantile(stretch, kJudgeShares[q]);
  now.max = stretch.empty() ? 0.0 : *std::max_element(stretch.begin(), stretch.end());
  now.beyond = static_cast<std::size_t>(
      std::count_if(stretch.begin(), stretch.end(), [&](double s) { return s > options.limit; }));
  now.flipped = flipped(level.triangles, posed, points);
  now.rest_error = level.added.report().rest_error;
  now.ambiguous = level.added.report().ambiguous.size();
  return now;
}

/// Halves of the edges before the last split that are to be halved on. The widest; and, since a jump across
/// a short edge is none of these, the most stretched of those whose edge is stretched unevenly.
/// \param points  of the finest level, posed
std::vector<Piece> TearJudge::Data::pieces(Points points) const {
  const TriangleMesh &before = levels[levels.size() - 2].triangles, &now = levels.back().triangles;
  const std::vector<Vec3>& rest_at = now.mesh.points;
  struct Half {
    std::size_t edge;
    std::uint32_t end;  ///< the other one is the edge's middle
    double gap, stretch, uneven;
  };
  std::vector<Half> all;
  for (std::size_t e = 0; e < before.edges.size(); ++e) {
    const std::size_t middle = before.mesh.points.size() + e;
    const auto& [a, b] = before.edges[e];
    const double half = 0.5 * (rest_at[a] - rest_at[b]).norm(), whole_gap = (points[a] - points[b]).norm();
    for (const std::uint32_t end : before.edges[e]) {
      const double gap = (points[end] - points[middle]).norm();
      if (half > 0.0 && gap >= options.least_gap * diagonal)
        all.push_back({e, end, gap, gap / half, 2.0 * gap / whole_gap});
    }
  }
  std::vector<Half> steep = all;
  std::erase_if(all, [](const Half& half) { return !(half.uneven > kUneven); });
  const auto by = [](double Half::*what) {
    return [what](const Half& a, const Half& b) { return a.*what > b.*what; };
  };
  keep_first(steep, options.halved, by(&Half::stretch));
  keep_first(all, options.halved, by(&Half::gap));
  all.insert(all.end(), steep.begin(), steep.end());
  std::sort(all.begin(), all.end(),
            [](const Half& a, const Half& b) { return std::tie(a.edge, a.end) < std::tie(b.edge, b.end); });
  const auto same = [](const Half& a, const Half& b) { return a.edge == b.edge && a.end == b.end; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  const std::vector<std::uint32_t> faces = before.faces_of_edges();
  std::vector<Piece> out;
  for (const Half& half : all) {
    const std::size_t middle = before.mesh.points.size() + half.edge;
    out.push_back(
        {{rest_at[half.end], rest_at[middle]}, {points[half.end], points[middle]}, faces[half.edge]});
  }
  return out;
}

void TearJudge::Data::find_tears(std::span<const CurvePair> posed, Points points, JudgeReport& report) const {
  Limits limits = find_limits(*binder, posed, pieces(points), options.least_gap * diagonal,
                              kShortest * diagonal, threads);
  report.verdict = limits.tears.empty() ? TearVerdict::smooth : TearVerdict::tear;
  report.torn = limits.tears.size();
  report.steepest = limits.steepest;
  // The widest first; those as wide in the order of edges.
  std::stable_sort(limits.tears.begin(), limits.tears.end(),
                   [](const Tear& a, const Tear& b) { return a.gap > b.gap; });
  limits.tears.resize(std::min(options.worst, limits.tears.size()));
  report.tears = std::move(limits.tears);
}

TearJudge::TearJudge(std::span<const CurvePair> rest, const PolygonMesh& mesh, const BindOptions& bind,
                     const JudgeOptions& options)
    : data_(std::make_unique<Data>(rest, mesh, bind, options)) {}

TearJudge::~TearJudge() = default;

const PolygonMesh& TearJudge::mesh() const {
  return data_->levels.front().triangles.mesh;
}

const Binding& TearJudge::own_binding() const {
  return *data_->own;
}

const Binding& TearJudge::binding() const {
  return data_->levels.front().added;
}

namespace {

void compare(const JudgeLevel& before, const JudgeLevel& now, JudgeReport& report) {
  for (std::size_t q = 0; q < kJudgeShares.size(); ++q)
    report.growth[q] = std::max(report.growth[q], ratio(now.quantile[q], before.quantile[q]));
  report.growth_of_max = std::max(report.growth_of_max, ratio(now.max, before.max));
  report.exponent = now.beyond == 0 ? 0.0
                                    : std::log2(static_cast<double>(now.beyond) /
                                                static_cast<double>(std::max<std::size_t>(before.beyond, 1)));
}

}  // namespace

JudgeReport TearJudge::judge(std::span<const CurvePair> posed) const {
  JudgeReport report;
  std::vector<Vec3> points, added;
  std::vector<WorstEdge> edges;
  for (const Data::Level& level : data_->levels) {
    added.resize(level.added.size());
    level.added.update(posed, added, data_->threads);
    points.insert(points.end(), added.begin(), added.end());
    JudgeLevel now = data_->look_at(level, posed, points, edges);
    if (report.levels.empty()) {
      keep_first(edges, data_->options.worst, more_stretched);
      report.worst = edges;
    } else {
      now.rest_error = std::max(now.rest_error, report.levels.back().rest_error);
      now.ambiguous += report.levels.back().ambiguous;
      compare(report.levels.back(), now, report);
    }
    report.levels.push_back(now);
  }
  data_->find_tears(posed, points, report);
  return report;
}

}  // namespace tendril::bind
