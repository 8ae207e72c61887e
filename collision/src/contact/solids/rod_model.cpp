#include "rod_model.h"

#include <algorithm>
#include <cmath>

namespace tendril::contact {
namespace {

/// Points h apart enter a solid that is widened to bend by R + r at least by at most h^2 / (8 (R + r)): with
/// h <= sqrt((R + r) range / 8), range / 64 (and half as much again where the edge is stretched). What comes
/// half the range near has some six points within it, so that the sum over them hardly feels where they are.
RodLines::Apart apart_for(const Solids& solids, double range) {
  return [&solids, range](double radius) {
    double least = std::numeric_limits<double>::infinity();
    for (const Collider& collider : solids.all)
      least = std::min(least, std::sqrt(0.125 * (collider.shape->outward_radius() + radius) * range));
    return least;
  };
}

}  // namespace

RodModel::RodModel(std::vector<ContactRod> rods, std::vector<Collider> with, const Law& how)
    : law(checked(how)),
      colliders(std::move(with), thickest(rods) + how.range),
      lines(std::move(rods), apart_for(colliders, how.range)) {
  // The sagitta of the bound above, for an edge stretched by a quarter: a margin that followed the edge's
  // present length would be one more term of the force.
  for (const LineEdge& edge : lines.edges) {
    const double apart = lines.widest(edge), radius = lines.rods[edge.rod].radius;
    for (const Collider& collider : colliders.all)
      margin.push_back(apart * apart / (8.0 * (collider.shape->outward_radius() + radius)));
  }
}

/// In the frame of a solid that moves, so that one bound covers the motion of both: distances are the same
/// there, and every point of the edge lies between its ends and so moves no farther than one of them.
double RodModel::moved(const Ledger& kept, const LineEdge& edge, const Vec3& a, const Vec3& b,
                       std::size_t collider, const Placement& placed) const {
  const Vec3 &a0 = kept.p[edge.global], &b0 = kept.p[edge.global + 1];
  if (!colliders[collider].moves())
    return std::sqrt(std::max((a - a0).squaredNorm(), (b - b0).squaredNorm()));
  const Placement& before = kept.placed[collider];
  return std::max((placed.to_local(a) - before.to_local(a0)).norm(),
                  (placed.to_local(b) - before.to_local(b0)).norm());
}

/// The distance alone, without derivatives: most points that are looked at turn out to be out of range.
Nearness RodModel::nearness(const StateView& state, std::size_t point, std::size_t collider,
                            const Placement& placed) const {
  const LinePoint& at = lines.points[point];
  const LineEdge& edge = lines.edges[at.edge];
  const std::size_t node = lines.node_of(state, edge);
  const double radius = lines.rods[edge.rod].radius;
  const Vec3 x = between(state.p[node], state.p[node + 1], at.fraction);
  const Vec3 local = placed.to_local(x);
  const double gap =
      colliders[collider].shape->distance(local) - radius - margin[at.edge * colliders.size() + collider];
  return {point, collider, x, local, gap, &placed, radius};
}

Vec3 RodModel::local_before(const Ledger& kept, const LinePoint& at, std::size_t collider) const {
  const std::size_t node = lines.edges[at.edge].global;
  return kept.placed[collider].to_local(between(kept.p[node], kept.p[node + 1], at.fraction));
}

bool RodModel::reachable(const Ledger& kept, const Nearness& near) const {
  const LinePoint& at = lines.points[near.point];
  const double taken = near.radius + margin[at.edge * colliders.size() + near.collider];
  return clear_way(*colliders[near.collider].shape, near, local_before(kept, at, near.collider), taken,
                   law.range);
}

}  // namespace tendril::contact
