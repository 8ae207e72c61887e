#include "branches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "facing.h"
#include "mesh/neighbours.h"
#include "mesh/parallel.h"
#include "soft_axis.h"

namespace tendril::bind {
namespace {

/// By how much the scale of the binding may fall per length on the mesh. The distance to a curve can fall by
/// 1, so near where the mesh meets its own axis the scale is bounded by that of the mesh around.
constexpr double kScaleSlope = 0.5;
constexpr double kSmallest = 1e-150;  ///< scale, so that its square is a number

using CandidateLists = std::vector<std::vector<Candidate>>;

/// Whether two projections of neighbours belong to one branch: seen from the middle of the two, no maximum of
/// the distance lies between them (which is sampled).
bool same_branch(std::span<const CurveProjector> projectors, const Vec3& middle, const Candidate& a,
                 const Candidate& b) {
  if (a.pair != b.pair) return false;
  const double to_a = (a.at.point - middle).norm(), to_b = (b.at.point - middle).norm();
  const double most = std::max(to_a, to_b) * (1.0 + 1e-9);
  for (const double part : {0.25, 0.5, 0.75}) {
    const double t = a.at.t + part * (b.at.t - a.at.t);
    if ((projectors[a.pair].curve().value(t) - middle).norm() > most) return false;
  }
  return true;
}

/// Closes the projections of a point that no path on the mesh, through the same branch of projections, joins
/// to a point where the branch is the nearest: a flood over (point, projection) from all nearest projections.
class Gate {
 public:
  Gate(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, const Neighbours& neighbours,
       CandidateLists& lists)
      : projectors_(projectors), mesh_(mesh), lists_(lists), neighbours_(neighbours) {}

  /// Points with a closed projection, ascending.
  std::vector<std::uint32_t> run() {
    for (auto& list : lists_)
      for (Candidate& c : list) c.open = false;
    for (std::uint32_t i = 0; i < lists_.size(); ++i) enter(i, 0);
    while (!waiting_.empty()) {
      const Node node = waiting_.back();
      waiting_.pop_back();
      for (const std::uint32_t next : neighbours_.of(node.point)) spread(node, next);
    }
    std::vector<std::uint32_t> gated;
    for (std::uint32_t i = 0; i < lists_.size(); ++i)
      if (std::any_of(lists_[i].begin(), lists_[i].end(), [](const Candidate& c) { return !c.open; }))
        gated.push_back(i);
    return gated;
  }

 private:
  struct Node {
    std::uint32_t point;
    std::size_t which;
  };

  void enter(std::uint32_t point, std::size_t which) {
    if (lists_[point][which].open) return;
    lists_[point][which].open = true;
    waiting_.push_back({point, which});
  }
  void spread(const Node& node, std::uint32_t next) {
    for (std::size_t k = 1; k < lists_[next].size(); ++k)
      if (!lists_[next][k].open &&
          same_branch(projectors_, 0.5 * (mesh_.points[node.point] + mesh_.points[next]),
                      lists_[node.point][node.which], lists_[next][k]))
        enter(next, k);
  }

  std::span<const CurveProjector> projectors_;
  const PolygonMesh& mesh_;
  CandidateLists& lists_;
  const Neighbours& neighbours_;
  std::vector<Node> waiting_;
};

/// Finds the branches of a mesh step by step, each in parts of the points or over the whole mesh.
class Search {
 public:
  Search(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band, int threads)
      : projectors_(projectors),
        mesh_(mesh),
        band_(band),
        threads_(threads),
        axis_(projectors, band),
        neighbours_(mesh),
        facing_(projectors, mesh, neighbours_, threads),
        lists_(mesh.points.size()),
        scales_(mesh.points.size()),
        margins_(mesh.points.size()) {}

  Branches run() {
    find_nearest();
    find_scales();
    find_margins();
    Branches branches;
    if (std::any_of(lists_.begin(), lists_.end(), [](const auto& list) { return list.size() > 1; }))
      branches.gated = Gate(projectors_, mesh_, neighbours_, lists_).run();
    share(branches);
    return branches;
  }

 private:
  template <class Do>
  void in_parts(const Do& each) const {
    bind::in_parts(mesh_.points.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) each(i);
    });
  }
  Site site(std::size_t point) const;
  std::vector<Candidate> candidates(const Site& site) const;
  void find_nearest();
  void find_scales();
  void find_margins();
  void share(Branches& branches) const;

  std::span<const CurveProjector> projectors_;
  const PolygonMesh& mesh_;
  double band_;
  int threads_;
  SoftAxis axis_;
  Neighbours neighbours_;
  Facing facing_;
  CandidateLists lists_;  ///< per point, the nearest projection first; the others where they are asked for
  std::vector<double> scales_, margins_;  ///< per point, see Site and SoftAxis::cut_margin
};

Site Search::site(std::size_t point) const {
  Site site{mesh_.points[point], scales_[point], {}, lists_[point]};
  const double unit = site.nearest().factor;
  for (std::uint32_t k = 0; k < projectors_.size(); ++k)
    site.factors.push_back(facing_.factor(point, k) / unit);
  return site;
}

/// All projections that count, the nearest first.
std::vector<Candidate> Search::candidates(const Site& site) const {
  const Candidate& nearest = site.nearest();
  const double reach = axis_.reach(site);
  std::vector<Candidate> out;
  for (std::uint32_t k = 0; k < projectors_.size(); ++k) {
    const double most = reach / site.factors[k];
    const double distance = k == nearest.pair ? nearest.at.distance : projectors_[k].nearest(site.p).distance;
    if (distance > most) continue;
    const double within = distance > 0.0 ? most / distance - 1.0 : std::numeric_limits<double>::infinity();
    for (const LocalMinimum& m : projectors_[k].all(site.p, within, nearest.at.t))
      if (!(m.distance > most)) out.push_back({k, m, nearest.factor * site.factors[k]});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance() < b.distance(); });
  return out;
}

/// On any of the curves.
void Search::find_nearest() {
  bind::in_parts(lists_.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::uint32_t k = 0; k < projectors_.size(); ++k) {
      const std::vector<Projection> nearest =
          projectors_[k].nearest(Points(mesh_.points).subspan(begin, end - begin));
      for (std::size_t i = begin; i < end; ++i) {
        const Projection& at = nearest[i - begin];
        const double factor = facing_.factor(i, k);
        if (k == 0 || factor * at.distance < lists_[i].front().distance())
          lists_[i] = {{k, {at, std::max(0.0, at.lambda), false, 1}, factor}};
      }
    }
    for (std::size_t i = begin; i < end; ++i) {
      Candidate& best = lists_[i].front();
      if (best.at.kind != ProjectionKind::interior)
        best.at = projectors_[best.pair].all(mesh_.points[i], 0.0, best.at.t).front();
    }
  });
}

/// The smallest function above the distance to the axis that falls by at most kScaleSlope.
void Search::find_scales() {
  for (std::size_t i = 0; i < scales_.size(); ++i) scales_[i] = -lists_[i].front().distance();
  bound_growth(
      mesh_, neighbours_, [&](std::uint32_t i) -> double& { return scales_[i]; },
      [](std::uint32_t, double length) { return kScaleSlope * length; });
  for (std::size_t i = 0; i < scales_.size(); ++i)
    scales_[i] = std::max(kSmallest, -scales_[i] / lists_[i].front().factor);
}

/// Where the nearest point jumps to another one close by, the margin rises from 0 to 1 over a length
/// comparable with the distance between the two, and the blend would change as fast. So the margins are
/// lowered to grow along no edge by more than its length over band scale, as they do beside the bisector of
/// two branches.
void Search::find_margins() {
  in_parts([&](std::size_t i) {
    margins_[i] = 1.0;
    Site here = site(i);
    if (!axis_.may_be_ambiguous(here)) return;
    lists_[i] = candidates(here);
    here.all = lists_[i];
    margins_[i] = std::min(1.0, axis_.cut_margin(here));
  });
  bound_growth(
      mesh_, neighbours_, [&](std::uint32_t i) -> double& { return margins_[i]; },
      [&](std::uint32_t i, double length) { return length / (band_ * scales_[i]); });
  in_parts([&](std::size_t i) {
    if (margins_[i] < 1.0 && lists_[i].size() == 1) lists_[i] = candidates(site(i));
  });
}

void Search::share(Branches& branches) const {
  branches.influences.resize(lists_.size());
  in_parts([&](std::size_t i) {
    const double weight = SoftAxis::blend_weight(margins_[i]);
    if (weight > 0.0) branches.influences[i] = axis_.influences(site(i));
    for (Influence& one : branches.influences[i]) one.weight *= weight;
  });
  for (std::uint32_t i = 0; i < lists_.size(); ++i) {
    if (!branches.influences[i].empty()) branches.ambiguous.push_back(i);
    branches.nearest.push_back(lists_[i].front());
    branches.clusters +=
        std::any_of(lists_[i].begin(), lists_[i].end(), [](const Candidate& c) { return c.at.cluster; });
  }
}

}  // namespace

Branches find_branches(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band,
                       int threads) {
  return Search(projectors, mesh, band, threads).run();
}

}  // namespace tendril::bind
