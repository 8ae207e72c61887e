#include "rod_model.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tendril::contact {
namespace {

constexpr double kStretch = 1.25;    // by which an edge may lengthen before its points stand too far apart
constexpr double kMostPoints = 1e7;  // of all rods
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string place_of_rod(std::size_t i) {
  return "contact.rods[" + std::to_string(i) + "]";
}

void check_rod(const ContactRod& rod, std::size_t i) {
  if (!(rod.radius > 0.0 && rod.radius < kInfinite))
    throw InvalidInput(place_of_rod(i) + ".radius", std::to_string(rod.radius), "a positive length");
  if (rod.rest.size() < 2)
    throw InvalidInput(place_of_rod(i) + ".rest", std::to_string(rod.rest.size()) + " points", "at least 2");
  if (!all_finite(rod.rest)) throw InvalidInput(place_of_rod(i) + ".rest", "not finite", "finite points");
}

}  // namespace

RodModel::RodModel(std::vector<ContactRod> of, std::vector<Collider> with, const Law& how)
    : rods(std::move(of)),
      colliders(std::move(with)),
      law(how),
      stick(how.stick_stiffness > 0.0 ? how.stick_stiffness : how.stiffness) {
  contact::check(law, "contact.law");
  double thickest = 0.0;
  for (std::size_t i = 0; i < rods.size(); ++i) {
    check_rod(rods[i], i);
    thickest = std::max(thickest, rods[i].radius);
  }
  if (rods.empty()) throw InvalidInput("contact.rods", "none", "at least one");
  if (colliders.empty()) throw InvalidInput("contact.colliders", "none", "at least one");
  for (std::size_t i = 0; i < colliders.size(); ++i) {
    contact::check(colliders[i], i, thickest + law.range);
    driven = driven || colliders[i].driven;
    if (colliders[i].body) bodies.push_back(*colliders[i].body);
  }
  for (std::uint32_t i = 0; i < rods.size(); ++i) {
    lay_points(i, static_cast<std::uint32_t>(nodes));
    nodes += rods[i].rest.size();
  }
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  lay_margins();
}

/// Points h apart enter a solid that is widened to bend by R + r at least by at most h^2 / (8 (R + r)): with
/// h <= sqrt((R + r) range / 8), range / 64 (and half as much again where the edge is stretched). What comes
/// half the range near has some six points within it, so that the sum over them hardly feels where they are.
std::size_t RodModel::parts_of(double length, double radius) const {
  double most = 1.0;
  for (const Collider& collider : colliders) {
    const double apart = std::sqrt(0.125 * (collider.shape->outward_radius() + radius) * law.range);
    most = std::max(most, std::ceil(length / apart));
  }
  if (!(most + static_cast<double>(points.size()) < kMostPoints))
    throw InvalidInput("contact.law.range", std::to_string(law.range),
                       "a range that less than 1e7 points along the rods are enough for");
  return static_cast<std::size_t>(most);
}

/// Points stand at the nodes and between them; each edge has those from its first node on, the last also its
/// end. A point's weight is half of what lies beside it, on either side.
void RodModel::lay_points(std::uint32_t rod, std::uint32_t global) {
  const std::vector<Vec3>& rest = rods[rod].rest;
  double before = 0.0;
  for (std::uint32_t i = 0; i + 1 < rest.size(); ++i) {
    const double length = (rest[i + 1] - rest[i]).norm();
    const std::size_t parts = parts_of(length, rods[rod].radius);
    const double part = length / static_cast<double>(parts);
    const bool last = i + 2 == rest.size();
    LineEdge edge{rod, i, global + i, static_cast<std::uint32_t>(points.size()), 0};
    const auto e = static_cast<std::uint32_t>(edges.size());
    for (std::size_t k = 0; k < parts + (last ? 1 : 0); ++k) {
      const double left = k == 0 ? before : part, right = k == parts ? 0.0 : part;
      points.push_back({e, static_cast<double>(k) / static_cast<double>(parts), 0.5 * (left + right)});
    }
    before = part;
    edge.end = static_cast<std::uint32_t>(points.size());
    edges.push_back(edge);
  }
}

/// The sagitta of the bound above, for an edge stretched by a quarter: a margin that followed the edge's
/// present length would be one more term of the force.
void RodModel::lay_margins() {
  for (const LineEdge& edge : edges) {
    const ContactRod& rod = rods[edge.rod];
    const double length = (rod.rest[edge.node + 1] - rod.rest[edge.node]).norm();
    const auto parts = static_cast<double>(parts_of(length, rod.radius));
    const double apart = kStretch * length / parts;
    for (const Collider& collider : colliders)
      margin.push_back(apart * apart / (8.0 * (collider.shape->outward_radius() + rod.radius)));
  }
}

std::vector<Placement> RodModel::place(const StateView& state) const {
  std::vector<Placement> result;
  result.reserve(colliders.size());
  for (const Collider& collider : colliders) result.push_back(collider.at(state));
  return result;
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
  const LinePoint& at = points[point];
  const LineEdge& edge = edges[at.edge];
  const std::size_t node = node_of(state, edge);
  const double radius = rods[edge.rod].radius;
  const Vec3 x = between(state.p[node], state.p[node + 1], at.fraction);
  const Vec3 local = placed.to_local(x);
  const double gap =
      colliders[collider].shape->distance(local) - radius - margin[at.edge * colliders.size() + collider];
  return {point, collider, x, local, gap, &placed, radius};
}

Vec3 RodModel::local_before(const Ledger& kept, const LinePoint& at, std::size_t collider) const {
  const std::size_t node = edges[at.edge].global;
  return kept.placed[collider].to_local(between(kept.p[node], kept.p[node + 1], at.fraction));
}

bool RodModel::reachable(const Ledger& kept, const Nearness& near) const {
  const LinePoint& at = points[near.point];
  const double taken = near.radius + margin[at.edge * colliders.size() + near.collider];
  return clear_way(*colliders[near.collider].shape, near, local_before(kept, at, near.collider), taken,
                   law.range);
}

}  // namespace tendril::contact
