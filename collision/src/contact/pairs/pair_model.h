#pragma once

#include <optional>

#include "contact/by_key.h"
#include "contact/response.h"
#include "exclusions.h"

namespace tendril::contact {

/// Pairs of edges that may come near each other while no node moves by more than half the skin from where it
/// was, what all have in common aside.
struct NeighbourList {
  std::vector<Vec3> p;  ///< where nodes were
  double skin = 0.0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< ascending, the first below the second
};

/// What two points that touch have come apart by where they met, for friction to pull with.
struct PairMeeting {
  std::uint64_t key;  ///< of the points
  Vec3 apart;         ///< in the world
  Vec3 friction;      ///< on the first
};

/// What is remembered besides what is told.
struct PairLedger final : RodRodMemory {
  std::vector<Vec3> p;                        ///< of all nodes of rods in contact
  std::vector<Vec3> m;                        ///< their directors; empty without friction
  std::shared_ptr<const NeighbourList> near;  ///< pairs that are looked at
  std::vector<double> slack;                  ///< of each: the least distance less that where response begins
  std::vector<PairMeeting> meetings;          ///< by ascending key, with friction
};

/// Two points of rods.
struct PointPair {
  std::size_t first, second;
  Vec3 apart;  ///< from the second to the first
  double gap;  ///< less the margin between points
};

struct PairModel {
  PairModel(std::vector<ContactRod> rods, const std::vector<RodJoint>& joints, const Law& law);

  Law law;
  RodLines lines;
  std::vector<double> widest2;  ///< per edge: the square of the way between points
  Exclusions exclusions;

  bool barrier() const { return law.kind == Law::Kind::barrier; }
  std::uint64_t key_of(const PointPair& at) const { return at.first * lines.points.size() + at.second; }
  /// The margin between points of two edges.
  double margin(std::uint32_t e, std::uint32_t f) const {
    return (widest2[e] + widest2[f]) / (8.0 * thick(e, f));
  }
  /// How far from each other points of two edges are when response begins.
  double meets(std::uint32_t e, std::uint32_t f) const { return thick(e, f) + margin(e, f) + law.range; }
  /// The sum of two edges' radii.
  double thick(std::uint32_t e, std::uint32_t f) const {
    return lines.rods[lines.edges[e].rod].radius + lines.rods[lines.edges[f].rod].radius;
  }
  /// w_x w_y / l
  double weight(const PointPair& at) const;
  /// The point of a line when nodes of rods in contact are at p.
  Vec3 point(const std::vector<Vec3>& p, std::size_t i) const {
    const std::uint32_t node = lines.edges[lines.points[i].edge].global;
    return between(p[node], p[node + 1], lines.points[i].fraction);
  }
  /// Edges that are nearer than response and skin.
  std::shared_ptr<const NeighbourList> search(std::vector<Vec3> p, double skin) const;
  /// The distance of two edges less that where response begins; where some of their points are left out,
  /// that of the others.
  double slack(const std::vector<Vec3>& p, std::uint32_t e, std::uint32_t f) const;
  /// Whether two points whose gap is open kept it so on the straight way from where they were.
  bool reachable(const std::vector<Vec3>& before, const PointPair& now) const;

  /// Calls visit(PointPair) for all points that are not left out, no farther apart than where response begins
  /// and `pad`; it returns false to end.
  template <class Visit>
  bool each_point(const std::vector<Vec3>& p, std::uint32_t e, std::uint32_t f, double pad,
                  Visit&& visit) const;

  /// Calls visit(PointPair) for all points that may be in the range of each other, or may have been on the
  /// way from the ledger's state: p is where nodes are now. It returns false to end.
  template <class Visit>
  void each_near(const std::vector<Vec3>& p, const PairLedger* kept, Visit&& visit) const;
};

/// How far every edge moved from one set of positions to another, the mean motion aside: the farther of its
/// ends.
std::vector<double> moved(const RodLines& lines, const std::vector<Vec3>& from, const std::vector<Vec3>& to);
/// The largest of them over all nodes.
double most_moved(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

template <class Visit>
bool PairModel::each_point(const std::vector<Vec3>& p, std::uint32_t e, std::uint32_t f, double pad,
                           Visit&& visit) const {
  const LineEdge &first = lines.edges[e], &second = lines.edges[f];
  const Vec3 &c = p[second.global], along = p[second.global + 1] - c;
  const double square = along.squaredNorm(), taken = thick(e, f) + margin(e, f);
  const double far = taken + law.range + pad;
  const Excluded* excluded = exclusions.between(e, f);
  const std::size_t columns = second.end - second.first;
  for (std::size_t i = first.first; i < first.end; ++i) {
    const Vec3 x = point(p, i), from = x - c;
    // Of the line, what lies within `far`: a window about the nearest point.
    const double at = square > 0.0 ? from.dot(along) / square : 0.0;
    const double left = far * far - (from - at * along).squaredNorm();
    if (!(left >= 0.0)) continue;
    const double wide = square > 0.0 ? std::sqrt(left / square) : 1.0;
    for (std::size_t j = second.first; j < second.end; ++j) {
      const double fraction = lines.points[j].fraction;
      if (fraction < at - wide) continue;
      if (fraction > at + wide) break;
      const Vec3 apart = from - fraction * along;
      if (excluded && exclusions.excludes(*excluded, i - first.first, j - second.first, columns)) continue;
      if (!visit(PointPair{i, j, apart, apart.norm() - taken})) return false;
    }
  }
  return true;
}

template <class Visit>
void PairModel::each_near(const std::vector<Vec3>& p, const PairLedger* kept, Visit&& visit) const {
  if (!kept) {
    const auto near = search(p, 0.0);
    for (const auto& [e, f] : near->pairs)
      if (!each_point(p, e, f, 0.0, visit)) return;
    return;
  }
  const std::vector<double> way = moved(lines, kept->p, p);
  if (2.0 * most_moved(kept->near->p, p) <= kept->near->skin) {
    for (std::size_t k = 0; k < kept->near->pairs.size(); ++k) {
      const auto [e, f] = kept->near->pairs[k];
      if (kept->slack[k] > way[e] + way[f]) continue;
      if (!each_point(p, e, f, way[e] + way[f], visit)) return;
    }
    return;
  }
  const auto near = search(p, 2.0 * most_moved(kept->p, p));
  for (const auto& [e, f] : near->pairs)
    if (!each_point(p, e, f, way[e] + way[f], visit)) return;
}

/// What two points do to each other.
struct PairTouch {
  PointPair at;
  Vec3 normal;    ///< from the second to the first
  Vec3 force;     ///< on the first, friction included
  Vec3 friction;  ///< of it
  bool sticks;
  Vec3 slid;    ///< what the surfaces have come apart by since the last accepted state
  Vec3 apart;   ///< what friction would pull with from here on
  double arm;   ///< from the first point to where the surfaces meet, against the normal
  Normal push;  ///< the normal force and its derivatives by the first point
};

/// The derivative of the unit vector between two points by the first.
Mat3 bend_of(const PointPair& at);

PairTouch respond(const PairModel& model, const StateView& state, const PairLedger* kept,
                  const PointPair& at);

/// Calls visit(PairTouch) for all points in the range of each other, in order. Ends at
/// the first that a barrier cannot let be where they are, and returns them; empty where there are none.
template <class Visit>
std::optional<PointPair> each_touch(const PairModel& model, const StateView& state,
                                    const std::vector<Vec3>& p, const PairLedger* kept, Visit&& visit) {
  std::optional<PointPair> closed;
  model.each_near(p, kept, [&](const PointPair& at) {
    if (model.barrier() && (!(at.gap > 0.0) || (kept && !model.reachable(kept->p, at)))) {
      closed = at;
      return false;
    }
    if (at.gap < model.law.range) visit(respond(model, state, kept, at));
    return true;
  });
  return closed;
}

}  // namespace tendril::contact
