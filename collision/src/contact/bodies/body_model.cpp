#include "body_model.h"

#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace tendril::contact {

BodyModel::BodyModel(std::vector<Collider> with, const Law& how)
    : law(checked(how)), colliders(std::move(with), 0.0) {
  reach.resize(colliders.size(), 0.0);
  for (std::size_t i = 0; i < colliders.size(); ++i)
    if (colliders[i].body) add_points(i);
  if (points.empty()) throw InvalidInput("contact.colliders", "no free body among them", "at least one");
  for (std::size_t i = 0; i < colliders.size(); ++i)
    if (colliders[i].body) add_pairs(i);
}

void BodyModel::add_points(std::size_t collider) {
  const std::vector<ShapePoint> all = colliders[collider].shape->points(law.range / 16.0);
  if (all.empty())
    throw InvalidInput("contact.colliders[" + std::to_string(collider) + "].shape", "no points to be met at",
                       "a shape that a free body can have");
  for (const ShapePoint& at : all) {
    points.push_back({collider, at, at.radius > 0.0 ? 2.0 * at.radius : law.range});
    reach[collider] = std::max(reach[collider], at.centre.norm() + at.radius);
  }
}

/// A round body meets everything; of two round ones the points of the first meet the second. What has edges
/// meets half spaces: nothing else bends outward by an infinite radius.
void BodyModel::add_pairs(std::size_t own) {
  const auto of_own = [&](const BodyPoint& point) { return point.collider == own; };
  const auto from = std::find_if(points.begin(), points.end(), of_own);
  const auto begin = static_cast<std::size_t>(from - points.begin());
  const auto end = begin + static_cast<std::size_t>(std::count_if(from, points.end(), of_own));
  const bool round = colliders[own].shape->round();
  for (std::size_t c = 0; c < colliders.size(); ++c) {
    if (c == own || (colliders[c].body && colliders[c].body == colliders[own].body)) continue;
    const bool other_round = colliders[c].body && colliders[c].shape->round();
    const bool flat = colliders[c].shape->outward_radius() == std::numeric_limits<double>::infinity();
    if (round ? !(other_round && c < own) : flat) {
      pairs.push_back({own, c, begin, end});
    } else if (!round && !other_round) {
      throw InvalidInput("contact.colliders[" + std::to_string(own) + "].shape",
                         "a body with edges could meet collider " + std::to_string(c) +
                             ", which is no half space and no free ball or capsule",
                         "a ball or a capsule");
    }
  }
}

std::vector<Moved> BodyModel::moved_since(const BodyLedger& kept,
                                          const std::vector<Placement>& placed) const {
  std::vector<Moved> moved;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Placement &now = placed[i], &before = kept.placed[i];
    moved.push_back({(now.position - before.position).norm(),
                     (now.rotation - before.rotation).norm() / std::numbers::sqrt2});
  }
  return moved;
}

/// By the balls about both, or where the second has none, as a half space, by how far the first's centre is
/// from it. In the frame of the second a point moves by what both do, and no farther.
bool BodyModel::far(const BodyPair& pair, const std::vector<Placement>& placed,
                    const std::vector<Moved>& moved) const {
  const Placement &first = placed[pair.first], &second = placed[pair.second];
  const Shape& shape = *colliders[pair.second].shape;
  const double apart = (first.position - second.position).norm(), around = shape.extent();
  const double least = around < std::numeric_limits<double>::infinity()
                           ? apart - around
                           : shape.distance(second.to_local(first.position));
  double way = 0.0;
  if (!moved.empty())
    way = moved[pair.first].way + reach[pair.first] * moved[pair.first].turn + moved[pair.second].way +
          (apart + reach[pair.first]) * moved[pair.second].turn;
  return least - reach[pair.first] > (law.range + way) * (1.0 + 1e-9);
}

Nearness BodyModel::nearness(std::size_t point, std::size_t collider,
                             const std::vector<Placement>& placed) const {
  const ShapePoint& at = points[point].at;
  const Vec3 x = placed[points[point].collider].to_world(at.centre);
  const Vec3 local = placed[collider].to_local(x);
  const double gap = colliders[collider].shape->distance(local) - at.radius;
  return {point, collider, x, local, gap, &placed[collider], at.radius};
}

bool BodyModel::reachable(const BodyLedger& kept, const Nearness& near) const {
  const BodyPoint& point = points[near.point];
  const Vec3 before =
      kept.placed[near.collider].to_local(kept.placed[point.collider].to_world(point.at.centre));
  return clear_way(*colliders[near.collider].shape, near, before, point.at.radius, law.range);
}

/// What comes into the range within a step slides from where it was when the step began: by how much the
/// points of both that meet now have come apart since.
Vec3 BodyModel::slid_since(const BodyLedger& kept, const std::vector<Placement>& placed, const Nearness& near,
                           const Vec3& surface) const {
  const std::size_t first = points[near.point].collider, second = near.collider;
  const Vec3 before =
      kept.placed[second].to_local(kept.placed[first].to_world(placed[first].to_local(surface)));
  return placed[second].rotation * (placed[second].to_local(surface) - before);
}

BodyContactPoint BodyModel::touch(const std::vector<Placement>& placed, const BodyLedger* kept,
                                  const Nearness& near) const {
  const BodyPoint& point = points[near.point];
  const Placement &first = placed[point.collider], &second = placed[near.collider];
  // Damping asks for the velocity along the normal alone, which is the same at the centre and at the surface.
  const Response response =
      respond(*colliders[near.collider].shape, law, point.weight, near, {}, first.velocity_at(near.x));
  const Vec3& n = response.normal;
  const Vec3 surface = near.x - near.radius * n;
  BodyContactPoint out{near, surface, response, near.point * colliders.size() + near.collider, Vec3::Zero()};
  if (law.friction == 0.0 || !kept) return out;
  const Meeting* was = find_key(kept->meetings, out.key);
  const Vec3 apart = was ? Vec3(second.rotation * was->pulled + first.to_world(was->on_first) -
                                second.to_world(was->on_second))
                         : slid_since(*kept, placed, near, surface);
  out.apart = apart - n.dot(apart) * n;
  const double push = out.response.force.dot(n);
  const Vec3 rate = first.velocity_at(surface) - second.velocity_at(surface);
  const Vec3 pulled = out.apart + law.stick_damping * (rate - n.dot(rate) * n);
  const double k = point.weight * stick_of(law), pull = k * pulled.norm(), most = law.friction * push;
  out.response.sticks = pull <= most;
  out.response.friction = -(out.response.sticks ? k : most / pulled.norm()) * pulled;
  const double far = kTrail * most / k;
  if (!out.response.sticks && out.apart.norm() > far) out.apart *= far / out.apart.norm();
  out.response.force += out.response.friction;
  return out;
}

}  // namespace tendril::contact
