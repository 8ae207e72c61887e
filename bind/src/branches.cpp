#include "branches.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "islands.h"
#include "parallel.h"
#include "soft_axis.h"

namespace tendril::bind {
namespace {

/// What may count at all is so much farther than the nearest, in units of `band`.
constexpr double kReach = 2.0;

using CandidateLists = std::vector<std::vector<Candidate>>;

/// The nearest projection on any of the curves; `hints` are those of the point before.
Candidate nearest_of(std::span<const CurveProjector> projectors, const Vec3& p, std::vector<double>& hints) {
  Candidate best{0, {}};
  for (std::uint32_t k = 0; k < projectors.size(); ++k) {
    const Projection at = projectors[k].nearest(p, hints[k]);
    hints[k] = at.t;
    if (k == 0 || at.distance < best.at.distance) best = {k, {at, std::max(0.0, at.lambda), false, 1}};
  }
  if (best.at.kind != ProjectionKind::interior)
    best.at = projectors[best.pair].all(p, 0.0, hints[best.pair]).front();
  return best;
}

/// All projections within the band, the nearest first.
std::vector<Candidate> candidates(std::span<const CurveProjector> projectors, const Vec3& p,
                                  const Candidate& nearest, double band) {
  const double reach = (1.0 + kReach * band) * nearest.at.distance;
  std::vector<Candidate> out;
  for (std::uint32_t k = 0; k < projectors.size(); ++k) {
    const double distance = k == nearest.pair ? nearest.at.distance : projectors[k].nearest(p).distance;
    if (distance > reach) continue;
    const double within = distance > 0.0 ? std::max(0.0, reach / distance - 1.0) : 0.0;
    for (const LocalMinimum& m : projectors[k].all(p, within, nearest.at.t)) out.push_back({k, m});
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Candidate& a, const Candidate& b) { return a.at.distance < b.at.distance; });
  return out;
}

/// Whether two projections of neighbours belong to one branch: from their middle, no hump of the distance
/// lies between them.
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

/// Closes the projections of a point that no way over the mesh, through the same branch of projections, joins
/// to a point where the branch is the nearest.
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

/// The projections of a point of an island: on the curve-pairs of the points around it alone.
std::vector<Candidate> bridged(std::span<const CurveProjector> projectors, const Vec3& p,
                               std::span<const std::uint32_t> pairs, double band) {
  Candidate nearest{0, {}};
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const LocalMinimum at = projectors[pairs[k]].all(p, 0.0).front();
    if (k == 0 || at.distance < nearest.at.distance) nearest = {pairs[k], at};
  }
  std::vector<Candidate> out{nearest};
  for (const Candidate& c : candidates(projectors, p, nearest, band)) {
    const bool other = c.pair != nearest.pair || c.at.t != nearest.at.t;
    if (other && std::binary_search(pairs.begin(), pairs.end(), c.pair)) out.push_back(c);
  }
  return out;
}

/// Gives the points of islands the projections of their surroundings. \return  those points, ascending
std::vector<std::uint32_t> bridge_islands(std::span<const CurveProjector> projectors, const PolygonMesh& mesh,
                                          const Neighbours& neighbours, double band, CandidateLists& lists) {
  std::vector<Candidate> nearest;
  for (const auto& list : lists) nearest.push_back(list.front());
  std::vector<std::uint32_t> points;
  for (const Island& island : find_islands(mesh, neighbours, nearest))
    for (const std::uint32_t i : island.points) {
      lists[i] = bridged(projectors, mesh.points[i], island.pairs, band);
      points.push_back(i);
    }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

Neighbours::Neighbours(const PolygonMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      edges.push_back({a, b});
      edges.push_back({b, a});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  begin.assign(mesh.points.size() + 1, 0);
  for (const auto& edge : edges) {
    ++begin[edge[0] + 1];
    to.push_back(edge[1]);
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

Branches find_branches(std::span<const CurveProjector> projectors, const PolygonMesh& mesh, double band,
                       int threads) {
  const std::size_t count = mesh.points.size();
  const SoftAxis axis(projectors);
  CandidateLists lists(count);
  in_parts(count, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<double> hints;
    for (const CurveProjector& projector : projectors) hints.push_back(projector.curve().knots().start());
    for (std::size_t i = begin; i < end; ++i) {
      const Candidate nearest = nearest_of(projectors, mesh.points[i], hints);
      lists[i] = {nearest};
      if (axis.may_be_ambiguous(mesh.points[i], nearest, band))
        lists[i] = candidates(projectors, mesh.points[i], nearest, band);
    }
  });
  Branches branches;
  const bool several = projectors.size() > 1;
  if (several || std::any_of(lists.begin(), lists.end(), [](const auto& list) { return list.size() > 1; })) {
    const Neighbours neighbours(mesh);
    std::vector<std::uint32_t> refused;
    if (several) refused = bridge_islands(projectors, mesh, neighbours, band, lists);
    const std::vector<std::uint32_t> gated = Gate(projectors, mesh, neighbours, lists).run();
    std::set_union(refused.begin(), refused.end(), gated.begin(), gated.end(),
                   std::back_inserter(branches.gated));
  }
  branches.influences.resize(count);
  in_parts(count, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double share = axis.ambiguity(mesh.points[i], lists[i], band);
      if (share > 0.0) branches.influences[i] = axis.influences(mesh.points[i], lists[i], kReach * band);
      for (Influence& one : branches.influences[i]) one.weight *= share;
    }
  });
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!branches.influences[i].empty()) branches.ambiguous.push_back(i);
    branches.nearest.push_back(lists[i].front());
    branches.clusters +=
        std::any_of(lists[i].begin(), lists[i].end(), [](const Candidate& c) { return c.at.cluster; });
  }
  return branches;
}

}  // namespace tendril::bind
