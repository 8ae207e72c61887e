#include "scene/solid/contact_stiffness.h"

#include <tendril/dynamics/force.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tendril::scene {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kCarries = 0.1;  // of an energy, by a barrier: kappa w range^2
constexpr double kAtTip = 0.5;    // of that, by the last point of a rod, or one of a surface
constexpr double kOfWay = 0.4;    // of the way between points, by the last

struct Size {
  double length = 0.0, mass = 0.0;
};
Size size_of(const Rod& rod) {
  Size out;
  for (std::size_t i = 0; i + 1 < rod.p.size(); ++i) out.length += (rod.p[i + 1] - rod.p[i]).norm();
  for (const double m : rod.mass) out.mass += m;
  return out;
}

/// Of the first and last edges of rods.
double shortest_end(const Scene& scene) {
  double least = kInfinite;
  for (const Rod& rod : scene.rods)
    least = std::min({least, (rod.p[1] - rod.p[0]).norm(), (rod.p.back() - rod.p[rod.p.size() - 2]).norm()});
  return least;
}

/// Whether a rod ends somewhere in the air.
bool has_tip(const Scene& scene, std::size_t rod) {
  const std::size_t last = scene.rods[rod].p.size() - 1;
  bool first_held = false, last_held = false;
  for (const Anchor& anchor : scene.anchors) {
    if (anchor.rod != rod || !anchor.holds_position) continue;
    first_held = first_held || anchor.node == 0;
    last_held = last_held || anchor.node == last;
  }
  for (const Joint& joint : scene.joints) first_held = first_held || joint.child == rod;
  return !first_held || !last_held;
}

/// Mass that a rod's last point has to stop: of what the rod is stiff enough for to come along, as far as its
/// weight does not bend it, (2 B / weight per length)^(1/3): a rod's springs are those of half edges. All of
/// it without weight.
double tip_mass(const Scene& scene, double g) {
  double most = 0.0;
  for (std::size_t r = 0; r < scene.rods.size(); ++r) {
    if (!has_tip(scene, r)) continue;
    const Rod& rod = scene.rods[r];
    const auto [length, mass] = size_of(rod);
    const double edge = length / static_cast<double>(rod.p.size() - 1);
    const double bending = edge * std::max(*std::max_element(rod.bend_l.begin(), rod.bend_l.end()),
                                           *std::max_element(rod.bend_m.begin(), rod.bend_m.end()));
    const double along = g > 0.0 ? std::cbrt(bending * length / (mass * g)) / length : 1.0;
    most = std::max(most, mass * std::min(1.0, along));
  }
  return most;
}

/// What is within half the range of a ball of the smallest radius: pi R range.
double round_area(const std::vector<contact::Collider>& colliders, double skin, double range) {
  double least = kInfinite;
  for (const contact::Collider& collider : colliders)
    least = std::min(least, std::numbers::pi * (collider.shape->outward_radius() + skin) * range);
  return least;
}

}  // namespace

Falling falling_of(const Scene& scene, double speed, double fall) {
  Falling out;
  for (const auto& force : scene.forces)
    if (const auto a = force->uniform_acceleration()) out.g = std::max(out.g, a->norm());
  for (const Rod& rod : scene.rods) {
    const auto [length, mass] = size_of(rod);
    out.length += length;
    out.mass += mass;
    out.longest = std::max(out.longest, length);
    out.heaviest = std::max(out.heaviest, mass);
  }
  out.energy = std::max(out.g * std::max(out.longest, fall), 0.5 * speed * speed);
  return out;
}

/// Carries a tenth of what all rods gain when they fall by the longest, met along their length, and every
/// body on a rod, where what is near is but sqrt(8 radius range) wide; and half of that on a rod's last
/// point, which stands for some 0.4 of the way to the next (rod_model.cpp).
double solids_stiffness(const Scene& scene, const Falling& falling,
                        const std::vector<contact::Collider>& colliders, double range, double radius) {
  double apart = shortest_end(scene);
  for (const contact::Collider& collider : colliders)
    apart = std::min(apart, std::sqrt(0.125 * (collider.shape->outward_radius() + radius) * range));
  double carried =
      std::max(falling.mass / falling.length, kAtTip * tip_mass(scene, falling.g) / (kOfWay * apart));
  for (const Body& body : scene.bodies)
    carried = std::max(carried, body.mass / std::sqrt(8.0 * radius * range));
  return kCarries * carried * falling.energy / (range * range);
}

/// A tenth of what the body has, on one of its points: 2 r of a round one, the range of a corner
/// (body_contact.h).
double bodies_stiffness(const Scene& scene, const Falling& falling,
                        const std::vector<contact::Collider>& colliders, double range) {
  double most = 0.0;
  for (const contact::Collider& collider : colliders) {
    if (!collider.body) continue;
    double least = kInfinite;
    for (const contact::ShapePoint& point : collider.shape->points(range / 16.0))
      least = std::min(least, point.radius > 0.0 ? 2.0 * point.radius : range);
    most = std::max(most,
                    kCarries * scene.bodies[*collider.body].mass * falling.energy / (least * range * range));
  }
  return most;
}

/// The same of two rods that cross, by the energy of the heaviest: near a crossing the sum of weights, as
/// a multiple of the gap's change, is 2 pi d / sqrt(2 d range), d the distance of the lines, so that the
/// barrier holds some kappa range^3 sqrt(20 d / range). And where a rod's last point meets the other's side
/// (pair_model.cpp).
double crossing_stiffness(const Scene& scene, const Falling& falling, double range, double radius) {
  const double apart = std::min(shortest_end(scene), std::sqrt(0.25 * radius * range));
  const double carried = std::max(falling.heaviest / std::sqrt(40.0 * radius * range),
                                  kAtTip * tip_mass(scene, falling.g) / (kOfWay * apart));
  return kCarries * carried * falling.energy / (range * range);
}

/// Carries a tenth of the energy on what is near a ball, and half of that on one point of the surface: what
/// is about a vertex, or as far as points are apart (surface_model.cpp).
double surface_stiffness(double energy, const std::vector<contact::Collider>& colliders, double skin,
                         double range, double area, std::size_t vertices) {
  double point = area / static_cast<double>(std::max<std::size_t>(1, vertices));
  for (const contact::Collider& collider : colliders)
    point = std::min(point, 6.0 / 32.0 * (collider.shape->outward_radius() + skin) * range);
  const double least = std::min({area, round_area(colliders, skin, range), kOfWay * point / kAtTip});
  return kCarries * energy / (least * range * range);
}

double balls_stiffness(double energy, const std::vector<contact::Collider>& colliders, double skin,
                       double range) {
  return kCarries * energy / (round_area(colliders, skin, range) * range * range);
}

/// Carries a tenth of the energy on what two edges that cross weigh (surface_self_contact.h):
/// both^2 / (16 (both + range (2 skin + range))), of edges that have two thirds of a triangle's area each.
double sheets_stiffness(double energy, double skin, double range, double triangle) {
  const double both = 4.0 / 3.0 * triangle;
  return kCarries * energy * 16.0 * (both + range * (2.0 * skin + range)) / (both * both * range * range);
}

}  // namespace tendril::scene
