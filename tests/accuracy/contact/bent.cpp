#include <tendril/dynamics/forces.h>

#include "accuracy/contact/cases.h"
#include "accuracy/contact/runs.h"
#include "support/numbers.h"
#include "support/rods.h"

/// Rods bent between plates, and off floors, against the elastica's known digits. B, the bending
/// stiffness, is 1 throughout; rods hardly stretch.
namespace tendril::contact {
namespace {

using tendril::test::kPi;
constexpr double kRadius = 1e-3, kRange = 1e-3;

/// Round, of bending stiffness 1, through points, of weight `weight` a length.
Rod rod_through(const std::vector<Vec3>& points, double weight = 1.0) {
  std::vector<Vec3> orientation;
  for (const Vec3& p : points) orientation.push_back(p + 0.1 * Vec3::UnitY());
  const double inertia = kPi * std::pow(kRadius, 4) / 4, area = kPi * kRadius * kRadius;
  return make_rod(points, orientation, {1.0 / inertia, 1.0 / inertia / 3, weight / area},
                  circular_section(kRadius));
}

/// A barrier of which half the range is left under `force` on a point.
Law law_for(double force) {
  return {.stiffness = force / -potential({.stiffness = 1.0, .range = kRange}, 0.5 * kRange).slope,
          .range = kRange};
}

/// What a plate does to a rod, and how high it keeps it: the mean of the contacts' heights by their forces.
struct Pressed {
  double force = 0.0, height = 0.0;
};
Pressed pressed_in(const Equilibrium& found) {
  Pressed out;
  for (const Contact& c : memory_of(found.state).contacts) {
    out.force -= c.force.z();
    out.height -= c.force.z() * c.point.z();
  }
  out.height /= out.force;
  return out;
}

/// A plate that faces down; `height` of time is that of a rod's line that touches it.
Collider plate_above(std::function<double(double)> height) {
  Collider plate{"plate", half_space(), {}};
  plate.driven = [height = std::move(height)](double t) {
    Placement at;
    at.rotation = Eigen::AngleAxisd(kPi, Vec3::UnitX()).toRotationMatrix();
    at.position = Vec3(0, 0, height(t) + kRadius);
    return at;
  };
  return plate;
}

Equilibrium equilibrium_of(const Scene& scene) {
  const System system(scene);
  return found_from(system, system.rest_state(), {.until = 1.0});
}

/// A quarter of a ring of radius 1 that a plate at a height presses: from its side, which moves out, to its
/// top, which moves down.
Pressed press_ring(double plate, int edges) {
  std::vector<Vec3> points;
  for (int i = 0; i <= edges; ++i) {
    const double angle = kPi / 2 * i / edges;
    points.emplace_back(std::cos(angle), 0, std::sin(angle));
  }
  const Rod rod = rod_through(points);
  Scene scene;
  scene.rods = {rod};
  scene.anchors.push_back({.rod = 0, .node = 0, .slide = Anchor::Slide::line, .slide_axis = Vec3::UnitX()});
  scene.anchors.push_back({.rod = 0,
                           .node = static_cast<std::size_t>(edges),
                           .slide = Anchor::Slide::line,
                           .slide_axis = Vec3::UnitZ()});
  const Collider above =
      plate_above([plate](double t) { return plate * t + (1.0 + 2 * kRange) * (1.0 - t); });
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, kRadius, rod.p}},
                                               std::vector<Collider>{above}, law_for(0.5))};
  return pressed_in(equilibrium_of(scene));
}

/// F R^2 / B on a ring pressed to the height H / R between plates.
double force_on_ring(double height, int edges) {
  double plate = 0.5 * height + 0.5 * kRange;
  for (int k = 0; k < 2; ++k) plate += 0.5 * height - press_ring(plate, edges).height;
  return 2.0 * press_ring(plate, edges).force;
}

/// A rod bent back between two plates 1 apart: the half above its apex, which lies flat from where it meets
/// the plate.
struct UBend {
  double force, curvature;  ///< F D^2 / B, kappa D
};
UBend bent_between_plates(int edges) {
  const double length = 1.8;
  std::vector<Vec3> points;
  for (int i = 0; i <= edges; ++i) points.emplace_back(0, 0, length * i / edges);
  const Rod rod = rod_through(points);
  Scene scene;
  scene.rods = {rod};
  scene.anchors.push_back({.rod = 0, .node = 0, .slide = Anchor::Slide::line, .slide_axis = Vec3::UnitX()});
  // Its end is turned to lie along the plate first, and would stay so by itself then.
  Anchor guide{.rod = 0, .node = static_cast<std::size_t>(edges), .holds_position = false};
  guide.motion = [](double t) {
    const double turn = -kPi / 2 * std::min(1.0, 2.0 * t);
    AnchorPose pose;
    const Mat3 by = Eigen::AngleAxisd(turn, Vec3::UnitY()).toRotationMatrix();
    pose.frame = {by * Vec3::UnitX(), Vec3::UnitY(), by * Vec3::UnitZ()};
    if (t < 0.5) pose.angular_velocity = -kPi * Vec3::UnitY();
    return pose;
  };
  scene.anchors.push_back(guide);
  const double end = 0.5 + 0.5 * kRange;
  const Collider plate = plate_above([end](double t) { return end + 1.4 * (1.0 - t); });
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, kRadius, rod.p}},
                                               std::vector<Collider>{plate}, law_for(2.0))};
  const Equilibrium found = equilibrium_of(scene);
  require(found.torque[1].norm() < 0.01, "what lies on the plate is straight");
  const auto [force, height] = pressed_in(found);
  return {force * 4.0 * height * height, found.torque[0].norm() * 2.0 * height};
}

/// A heavy rod on a floor, lifted at one end by delta: l = (24 B delta / q)^(1/4) comes off, and q l / 2
/// lifts it.
double lift(int edges) {
  const double delta = 1e-3, free = 0.5, weight = 24.0 * delta / std::pow(free, 4);
  std::vector<Vec3> points;
  for (int i = 0; i <= edges; ++i) points.emplace_back(static_cast<double>(i) / edges, 0, 0);
  const Rod rod = rod_through(points, weight);
  Scene scene;
  scene.rods = {rod};
  Anchor hand{.rod = 0, .node = 0, .holds_frame = false};
  hand.motion = [=](double t) {
    AnchorPose pose;
    pose.position = Vec3(0, 0, delta * t);
    pose.velocity = Vec3(0, 0, delta);
    return pose;
  };
  scene.anchors.push_back(hand);
  const double range = 1e-6;
  const Law law{.stiffness = weight / -potential({.stiffness = 1.0, .range = range}, 0.5 * range).slope,
                .range = range};
  const Collider floor{"floor", half_space(), {.position = Vec3(0, 0, -kRadius - 0.5 * range)}};
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, kRadius, rod.p}},
                                               std::vector<Collider>{floor}, law),
                  std::make_shared<Gravity>(Vec3(0, 0, -1))};
  return equilibrium_of(scene).support[0].z() / (0.5 * weight * free);
}

/// Heavy cantilever at height h over a floor, small slopes, on the floor along a line.
double clamp_force(int edges, double range) {
  const double q = 1.0, h = 1e-3, length = 1.0, ratio = 200.0;
  const double bending = q * std::pow(length, 4) / (h * ratio);
  Rod rod = tendril::test::straight_rod(edges, 1.0, 0.01);
  const double area = kPi * 1e-4, inertia = kPi * 1e-8 / 4;
  const double young = bending / inertia;
  rod = make_rod(rod.p, rod.q, {young, young / 3, q / area}, circular_section(0.01));
  Scene scene;
  scene.rods = {rod};
  scene.anchors.push_back({.rod = 0, .node = 0});
  // On the floor the weight q is carried at the gap g of kappa b'(g) = -q.
  const double gap = 0.5 * range;
  const Law law{.stiffness = q / -potential({.stiffness = 1.0, .range = range}, gap).slope, .range = range};
  const Collider floor{"floor", half_space(), {.position = Vec3(0, 0, -h - 0.01 - gap)}};
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, 0.01, rod.p}},
                                               std::vector<Collider>{floor}, law),
                  std::make_shared<Gravity>(Vec3(0, 0, -1))};
  const System system(scene);
  const Equilibrium found = found_from(system, system.rest_state());
  require(found.stability.kind == Stability::Kind::stable, "what lies on a floor is stable");
  return found.support[0].z();
}

/// P a^2 / B of a beam bent over two supports that it slides on, a apart from the load on either side, where
/// it meets them at an angle: cos al [int_0^al cos th / sqrt(sin(al - th)) dth]^2, the root taken out.
double three_points(double angle) {
  const int n = 2000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) * std::sqrt(angle) / n, phi = s * s;
    sum += std::cos(angle - phi) * 2.0 / std::sqrt(std::sin(phi) / phi) * std::sqrt(angle) / n;
  }
  return std::cos(angle) * sum * sum;
}

/// Half of such a beam: clamped in the middle, lifted by a pin until it meets it at over 30 degrees. How far
/// force, place and angle are off each other.
double off_three_points(int edges, double lift) {
  const double length = 1.4, radius = 2e-3, pin = 2e-3, gap = 5e-4;
  Rod rod = tendril::test::straight_rod(edges, 1.0, radius);
  for (Vec3& p : rod.p) p *= length;
  for (Vec3& q : rod.q) q.x() *= length;
  const double inertia = kPi * std::pow(radius, 4) / 4, bending = 1.0;
  rod = make_rod(rod.p, rod.q, {bending / inertia, bending / inertia / 3, 1.0}, circular_section(radius));
  Scene scene;
  scene.rods = {rod};
  scene.anchors.push_back({.rod = 0, .node = 0});
  Collider below{"pin", cylinder(pin, std::numeric_limits<double>::infinity()), {}};
  const Mat3 across = Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()).toRotationMatrix();
  below.driven = [=](double t) {
    Placement at;
    at.rotation = across;
    at.position = Vec3(1.0, 0, -radius - pin - gap + lift * t);
    return at;
  };
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                               std::vector<Collider>{below},
                                               Law{.stiffness = 1e6, .range = 4e-4})};
  const System system(scene);
  const Equilibrium found = found_from(system, system.rest_state(), {.until = 1.0});
  const Vec3 push = -found.support[0], at = below.driven(1.0).position;
  const double angle = std::atan2(std::abs(push.x()), push.z());
  double nearest = 1e9, arm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(edges); ++i)
    for (int k = 0; k <= 1000; ++k) {
      const Vec3 x = place(found.state, i) + 1e-3 * k * (place(found.state, i + 1) - place(found.state, i));
      if ((x - at).norm() < nearest) nearest = (x - at).norm(), arm = x.x();
    }
  require(angle > kPi / 6, "a beam that meets its supports at over 30 degrees");
  return 2.0 * push.z() * arm * arm / bending / three_points(angle) - 1.0;
}

}  // namespace

Case pressed_ring() {
  Case out{"K4", "Ring between two plates",
           "F R^2 / B = 1 and 2 at the heights 1.833056 and 1.626471 R; pressed flat, F H^2 / B = 5.742160"};
  for (const auto& [height, force] :
       {std::pair(1.833056, 1.0), std::pair(1.626471, 2.0), std::pair(1.3, 5.742160 / 1.69)}) {
    char name[32];
    std::snprintf(name, sizeof name, "F R^2 / B at %.6g R", height);
    Quantity pressed{name, force, "relative"};
    for (const int edges : {16, 32})
      pressed.rows.push_back(relative(edges, force_on_ring(height, edges), force));
    pressed.order = Order{2.2, 0.4, 32};
    out.quantities.push_back(pressed);
    out.quantities.push_back(fine(pressed, relative(64, force_on_ring(height, 64), force), 1e-3));
  }
  return out;
}

Case bent_back() {
  Case out{"K3", "Rod bent back between two plates", "F D^2 / B = 2.871080, kappa D = 2.396280 at the bend"};
  Quantity force{"F D^2 / B", 2.871080, "relative"}, curvature{"kappa D", 2.396280, "relative"};
  for (const int edges : {32, 64}) {
    const UBend found = bent_between_plates(edges);
    force.rows.push_back(relative(edges, found.force, force.reference));
    curvature.rows.push_back(relative(edges, found.curvature, curvature.reference));
  }
  force.limits = curvature.limits = {{64, 1e-3}};
  out.quantities = {force, curvature};
  return out;
}

Case three_point_bending() {
  Case out{"K5", "Beam bent over two supports that it slides on",
           "P a^2 / B = cos(al) [int_0^al cos(th) / sqrt(sin(al - th)) dth]^2, al the angle at the supports, "
           "40 degrees here"};
  require(std::abs(three_points(kPi / 6) - 1.577869) < 1e-6 &&
              std::abs(three_points(38.30121 * kPi / 180) - 1.667952) < 1e-6,
          "the closed form has its known digits");
  Quantity force{"P a^2 / B over that of the angle found", 1.0, "relative"};
  for (const int edges : {32, 64}) {
    const double off = off_three_points(edges, 0.4);
    force.rows.push_back({edges, 1.0 + off, off});
  }
  force.limits = {{64, 1e-3}};
  out.quantities = {force};
  return out;
}

Case heavy_rod_on_a_floor() {
  Case out{
      "K6", "Heavy rod on a floor, small slopes",
      "a cantilever at the height h with q L^4 / (B h) = 200: free over (72 B h / q)^(1/4), two thirds of "
      "that weight on the clamp; lifted by delta: l = (24 B delta / q)^(1/4) comes off, q l / 2 lifts it"};
  Quantity clamp{"force on the clamp over q L", 2.0 / 3.0 * std::pow(72.0 / 200.0, 0.25), "relative"};
  for (const int edges : {16, 32})
    clamp.rows.push_back(relative(edges, clamp_force(edges, 1e-6), clamp.reference));
  clamp.order = Order{2.0, 0.2, 32};
  Quantity lifted{"lift over q l / 2", 1.0, "relative"};
  for (const int edges : {16, 32, 64}) lifted.rows.push_back(relative(edges, lift(edges), 1.0));
  lifted.limits = {{64, 1e-3}};
  out.quantities = {clamp, fine(clamp, relative(64, clamp_force(64, 1e-6), clamp.reference), 1e-3), lifted};
  return out;
}

}  // namespace tendril::contact
