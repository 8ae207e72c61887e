#include "branches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loose_parts.h"
#include "mesh/parallel.h"
#include "soft_axis.h"
#include "ways.h"

namespace tendril::bind {
namespace {

/// Voxels along the longest side of a body.
constexpr int kVoxels = 80;
/// By how much the scale of the binding may fall per length along the body. The distance to a curve can
/// fall by 1, so near where the mesh meets its own axis the scale is bounded by that of the mesh around.
constexpr double kScaleSlope = 0.5;
constexpr double kSmallest = 1e-150;  ///< scale, so that its square is a number

using CandidateLists = std::vector<std::vector<Candidate>>;

/// body(begin, end) over [0, count) by threads, a few hundred at a time: what is known of so many points and
/// each of hundreds of curves takes little room.
template <class Body>
void in_blocks(std::size_t count, int threads, const Body& body) {
  constexpr std::size_t kMost = 512;
  in_parts(count, threads, [&](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kMost) body(begin, std::min(end, begin + kMost));
  });
}

/// Whether two projections of neighbours belong to one branch: seen from the middle of the two, no maximum of
/// the distance lies between them (which is sampled).
bool same_branch(const SoftAxis& axis, const Vec3& middle, const Candidate& a, const Candidate& b) {
  if (a.pair != b.pair) return false;
  const double to_a = (a.at.point - middle).norm(), to_b = (b.at.point - middle).norm();
  const double most = std::max(to_a, to_b) * (1.0 + 1e-9);
  for (const double part : {0.25, 0.5, 0.75}) {
    const double t = a.at.t + part * (b.at.t - a.at.t);
    if ((axis.value(a.pair, t) - middle).norm() > most) return false;
  }
  return true;
}

/// Closes the projections of a node that no path along the body, through the same branch of projections,
/// joins to a node where the branch is the nearest: a flood over (node, projection) from all nearest
/// projections.
class Gate {
 public:
  Gate(const SoftAxis& axis, const BodyGrid& grid, CandidateLists& lists)
      : axis_(axis), grid_(grid), lists_(lists) {}

  void run() {
    for (auto& list : lists_)
      for (Candidate& c : list) c.open = false;
    for (std::uint32_t i = 0; i < lists_.size(); ++i) enter(i, 0);
    while (!waiting_.empty()) {
      const Reached node = waiting_.back();
      waiting_.pop_back();
      for (const std::uint32_t next : grid_.neighbours().of(node.point)) spread(node, next);
    }
  }

 private:
  struct Reached {
    std::uint32_t point;
    std::size_t which;
  };

  void enter(std::uint32_t point, std::size_t which) {
    if (lists_[point][which].open) return;
    lists_[point][which].open = true;
    waiting_.push_back({point, which});
  }
  void spread(const Reached& node, std::uint32_t next) {
    for (std::size_t k = 1; k < lists_[next].size(); ++k)
      if (!lists_[next][k].open && same_branch(axis_, 0.5 * (grid_.nodes()[node.point] + grid_.nodes()[next]),
                                               lists_[node.point][node.which], lists_[next][k]))
        enter(next, k);
  }

  const SoftAxis& axis_;
  const BodyGrid& grid_;
  CandidateLists& lists_;
  std::vector<Reached> waiting_;
};

}  // namespace

/// What is known at the nodes of the grid, and of points in between.
struct BodyBranches::Data {
  Data(std::span<const CurveProjector> curves, const PolygonMesh& body, double width, int threads)
      : projectors(curves),
        band(width),
        axis(curves, width),
        grid(body, kVoxels),
        distances(curves, grid.nodes(), threads),
        ways(curves, grid, distances, threads),
        lists(grid.nodes().size()),
        scales(lists.size()),
        margins(lists.size()) {
    find_nearest(threads);
    find_scales();
    find_margins(threads);
    if (std::any_of(lists.begin(), lists.end(), [](const auto& list) { return list.size() > 1; }))
      Gate(axis, grid, lists).run();
    faces = grid.faces_of_points(body);
    loose = LooseParts(body, projectors, [&](std::uint32_t point, std::uint32_t pair) {
      return ways.factor(grid.place(body.points[point], faces[point]), pair);
    });
  }

  /// What is known of a point and a curve without a projection.
  struct Known {
    double factor;
    CurveDistances::Bounds distance;
  };
  /// Adds what is known of each curve.
  void know_node(std::uint32_t node, std::vector<Known>& out) const;
  void know(const Vec3& p, const GridPlace& place, std::vector<Known>& out) const;

  static Site site(const Vec3& p, double scale, std::span<const Known> known, std::span<const Candidate> all);
  Site site_of_node(std::uint32_t node) const;
  std::vector<Candidate> candidates(const Site& site) const;
  /// \param known  of each point and curve, point after point
  void nearest_to(Points points, std::span<const Known> known, Candidate* out) const;
  void find_nearest(int threads);
  void find_scales();
  void find_margins(int threads);
  void open_by_nodes(const Vec3& p, const GridPlace& place, std::vector<Candidate>& list) const;
  void bind(const Vec3& p, const GridPlace& place, std::span<const Known> known, Candidate& nearest,
            std::vector<Influence>& influences, bool& gated, bool& cluster) const;

  std::span<const CurveProjector> projectors;
  double band;
  SoftAxis axis;
  BodyGrid grid;
  CurveDistances distances;
  Ways ways;
  CandidateLists lists;  ///< per node, the nearest projection first; the others where they are asked for
  std::vector<double> scales,
      margins;  ///< per node: of BindOptions::band, times the nearest's factor; cut_margin
  LooseParts loose;
  std::vector<std::uint32_t> faces;  ///< one for each point of the body
};

void BodyBranches::Data::know_node(std::uint32_t node, std::vector<Known>& out) const {
  for (std::uint32_t k = 0; k < projectors.size(); ++k)
    out.push_back({ways.factor(node, k), distances.bounds(k, node, 0.0)});
}

void BodyBranches::Data::know(const Vec3& p, const GridPlace& place, std::vector<Known>& out) const {
  const auto heaviest = std::max_element(place.weight.begin(), place.weight.end()) - place.weight.begin();
  const std::uint32_t node = place.node[static_cast<std::size_t>(heaviest)];
  const double away = (p - grid.nodes()[node]).norm();
  for (std::uint32_t k = 0; k < projectors.size(); ++k)
    out.push_back({ways.factor(place, k), distances.bounds(k, node, away)});
}

/// Factors are over that of the nearest.
Site BodyBranches::Data::site(const Vec3& p, double scale, std::span<const Known> known,
                              std::span<const Candidate> all) {
  Site out{p, std::max(kSmallest, scale), {}, all};
  for (const Known& one : known)
    out.curves.push_back({one.factor / out.nearest().factor, one.distance.least});
  return out;
}

Site BodyBranches::Data::site_of_node(std::uint32_t node) const {
  std::vector<Known> known;
  know_node(node, known);
  return site(grid.nodes()[node], scales[node] / lists[node].front().factor, known, lists[node]);
}

/// All projections that count, the nearest first.
std::vector<Candidate> BodyBranches::Data::candidates(const Site& site) const {
  const Candidate& nearest = site.nearest();
  const double reach = axis.reach(site);
  std::vector<Candidate> out;
  for (std::uint32_t k = 0; k < projectors.size(); ++k) {
    const double most = reach / site.curves[k].factor;
    if (site.curves[k].least > most) continue;
    Projection first = nearest.at;
    if (k != nearest.pair) first = projectors[k].nearest(site.p);
    const double distance = first.distance;
    if (distance > most) continue;
    const double within = distance > 0.0 ? most / distance - 1.0 : std::numeric_limits<double>::infinity();
    for (const LocalMinimum& m : projectors[k].all(site.p, within, first.t))
      if (!(m.distance > most)) out.push_back({k, m, nearest.factor * site.curves[k].factor});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance() < b.distance(); });
  return out;
}

/// On any of the curves, of each point: projected to those alone that its bounds leave.
void BodyBranches::Data::nearest_to(Points points, std::span<const Known> known, Candidate* out) const {
  const std::size_t curves = projectors.size();
  std::vector<double> most(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const Known& one : known.subspan(i * curves, curves))
      most[i] = std::min(most[i], one.factor * one.distance.most);
  std::vector<bool> any(points.size(), false);
  std::vector<std::size_t> which;
  std::vector<Vec3> some;
  for (std::uint32_t k = 0; k < projectors.size(); ++k) {
    which.clear();
    some.clear();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (known[i * curves + k].factor * known[i * curves + k].distance.least <= most[i]) {
        which.push_back(i);
        some.push_back(points[i]);
      }
    const std::vector<Projection> nearest = projectors[k].nearest(some);
    for (std::size_t n = 0; n < which.size(); ++n) {
      const std::size_t i = which[n];
      const Projection& at = nearest[n];
      const double factor = known[i * curves + k].factor;
      if (!any[i] || factor * at.distance < out[i].distance())
        out[i] = {k, {at, std::max(0.0, at.lambda), false, 1}, factor};
      any[i] = true;
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (out[i].at.kind != ProjectionKind::interior)
      out[i].at = projectors[out[i].pair].all(points[i], 0.0, out[i].at.t).front();
}

void BodyBranches::Data::find_nearest(int threads) {
  std::vector<Candidate> nearest(lists.size());
  in_blocks(lists.size(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Known> known;
    known.reserve((end - begin) * projectors.size());
    for (std::size_t i = begin; i < end; ++i) know_node(static_cast<std::uint32_t>(i), known);
    nearest_to(grid.nodes().subspan(begin, end - begin), known, nearest.data() + begin);
  });
  for (std::size_t i = 0; i < lists.size(); ++i) lists[i] = {nearest[i]};
}

/// The smallest function above the distance to the axis that falls by at most kScaleSlope.
void BodyBranches::Data::find_scales() {
  for (std::size_t i = 0; i < scales.size(); ++i) scales[i] = -lists[i].front().distance();
  bound_growth(
      grid.nodes(), grid.neighbours(), [&](std::uint32_t i) -> double& { return scales[i]; },
      [](std::uint32_t, double length) { return kScaleSlope * length; });
  for (double& scale : scales) scale = -scale;
}

/// Where the nearest point jumps to another one close by, the margin rises from 0 to 1 over a length
/// comparable with the distance between the two, and the blend would change as fast. So the margins are
/// lowered to grow between nodes by no more than their distance over band scale, as they do beside the
/// bisector of two branches.
void BodyBranches::Data::find_margins(int threads) {
  const auto each = [&](const auto& act) {
    in_parts(lists.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) act(static_cast<std::uint32_t>(i));
    });
  };
  each([&](std::uint32_t i) {
    margins[i] = 1.0;
    Site here = site_of_node(i);
    if (!axis.may_be_ambiguous(here)) return;
    lists[i] = candidates(here);
    here.all = lists[i];
    margins[i] = std::min(1.0, axis.cut_margin(here));
  });
  bound_growth(
      grid.nodes(), grid.neighbours(), [&](std::uint32_t i) -> double& { return margins[i]; },
      [&](std::uint32_t i, double length) {
        return length * lists[i].front().factor / (band * std::max(kSmallest, scales[i]));
      });
  each([&](std::uint32_t i) {
    if (margins[i] < 1.0 && lists[i].size() == 1) lists[i] = candidates(site_of_node(i));
  });
}

/// Open are those on the branch of an open one of a node beside the point.
void BodyBranches::Data::open_by_nodes(const Vec3& p, const GridPlace& place,
                                       std::vector<Candidate>& list) const {
  for (std::size_t k = 1; k < list.size(); ++k) {
    list[k].open = false;
    for (std::size_t n = 0; n < 8 && !list[k].open; ++n) {
      if (!(place.weight[n] > 0.0)) continue;
      const Vec3 middle = 0.5 * (p + grid.nodes()[place.node[n]]);
      for (const Candidate& c : lists[place.node[n]])
        if (c.open && same_branch(axis, middle, c, list[k])) list[k].open = true;
    }
  }
}

/// \param nearest  of all curves
void BodyBranches::Data::bind(const Vec3& p, const GridPlace& place, std::span<const Known> known,
                              Candidate& nearest, std::vector<Influence>& influences, bool& gated,
                              bool& cluster) const {
  const double scale = place.mean([&](std::uint32_t node) { return scales[node]; }) / nearest.factor;
  std::vector<Candidate> list{nearest};
  Site here = site(p, std::max(nearest.at.distance, scale), known, list);
  // Of what they lack to 1, so that among nodes that lack nothing it is 1, not rounded.
  double margin = 1.0 - place.mean([&](std::uint32_t node) { return 1.0 - margins[node]; });
  const bool may_be = axis.may_be_ambiguous(here);
  if (may_be || margin < 1.0) {
    list = candidates(here);
    here.all = list;
    if (may_be) margin = std::min(margin, axis.cut_margin(here));
  }
  nearest = list.front();
  if (list.size() > 1) open_by_nodes(p, place, list);
  gated = std::any_of(list.begin(), list.end(), [](const Candidate& c) { return !c.open; });
  cluster = std::any_of(list.begin(), list.end(), [](const Candidate& c) { return c.at.cluster; });
  const double weight = SoftAxis::blend_weight(margin);
  if (!(weight > 0.0)) return;
  influences = axis.influences(here);
  for (Influence& one : influences) one.weight *= weight;
}

BodyBranches::BodyBranches(std::span<const CurveProjector> projectors, const PolygonMesh& body, double band,
                           int threads)
    : data_(std::make_unique<Data>(projectors, body, band, threads)) {}

BodyBranches::~BodyBranches() = default;

Branches BodyBranches::find(Points points, std::span<const std::uint32_t> face, int threads) const {
  const std::span<const std::uint32_t> face_of =
      face.empty() ? std::span<const std::uint32_t>(data_->faces) : face;
  Branches out;
  out.nodes = data_->axis.nodes();
  out.loose = data_->loose.list();
  out.nearest.resize(points.size());
  out.influences.resize(points.size());
  std::vector<std::uint8_t> gated(points.size(), 0), cluster(points.size(), 0);
  in_blocks(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    const std::size_t curves = data_->projectors.size();
    std::vector<GridPlace> places;
    std::vector<Data::Known> known;
    known.reserve((end - begin) * curves);
    for (std::size_t i = begin; i < end; ++i) {
      places.push_back(data_->grid.place(points[i], face_of[i]));
      data_->know(points[i], places.back(), known);
    }
    data_->nearest_to(points.subspan(begin, end - begin), known, out.nearest.data() + begin);
    for (std::size_t i = begin; i < end; ++i) {
      if (const Candidate* held = data_->loose.held(face_of[i])) {
        out.nearest[i] = *held;
        continue;
      }
      bool is_gated = false, is_cluster = false;
      data_->bind(points[i], places[i - begin], std::span(known).subspan((i - begin) * curves, curves),
                  out.nearest[i], out.influences[i], is_gated, is_cluster);
      gated[i] = is_gated;
      cluster[i] = is_cluster;
    }
  });
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!out.influences[i].empty()) out.ambiguous.push_back(i);
    if (gated[i] != 0) out.gated.push_back(i);
    out.clusters += cluster[i];
  }
  return out;
}

Branches find_branches(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band,
                       int threads) {
  return BodyBranches(projectors, mesh, band, threads).find(mesh.points, {}, threads);
}

}  // namespace tendril::bind
