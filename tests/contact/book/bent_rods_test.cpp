#include <gtest/gtest.h>
#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/statics.h>

#include "memory.h"
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
  for (const Contact& c : test::memory_of(found.state).contacts) {
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
  const Equilibrium found = find_equilibrium(system, system.rest_state(), {.until = 1.0});
  EXPECT_EQ(found.balance, Balance::converged) << found.reason;
  return found;
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

TEST(ContactBook, ARingBetweenPlates) {
  const auto off = [](double height, double force, int edges) {
    return std::abs(force_on_ring(height, edges) / force - 1.0);
  };
  for (const auto& [height, force] :
       {std::pair(1.833056, 1.0), std::pair(1.626471, 2.0), std::pair(1.3, 5.742160 / 1.69)}) {
    const double coarse = off(height, force, 16), middle = off(height, force, 32),
                 fine = off(height, force, 64);
    std::cout << "ring pressed to " << height << ", force off by " << coarse << ", " << middle << ", " << fine
              << "\n";
    EXPECT_LE(fine, 1e-3);
    EXPECT_GE(std::log2(coarse / middle), 1.8);
  }
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
  EXPECT_LT(found.torque[1].norm(), 0.01);
  const auto [force, height] = pressed_in(found);
  return {force * 4.0 * height * height, found.torque[0].norm() * 2.0 * height};
}

TEST(ContactBook, ARodBentBackBetweenPlates) {
  const UBend coarse = bent_between_plates(32), fine = bent_between_plates(64);
  std::cout << "U-bend, force off by " << coarse.force / 2.871080 - 1 << ", " << fine.force / 2.871080 - 1
            << ", curvature by " << coarse.curvature / 2.396280 - 1 << ", " << fine.curvature / 2.396280 - 1
            << "\n";
  EXPECT_NEAR(fine.force / 2.871080, 1.0, 1e-3);
  EXPECT_NEAR(fine.curvature / 2.396280, 1.0, 1e-3);
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

TEST(ContactBook, AHeavyRodIsLiftedOffAFloor) {
  const double coarse = std::abs(lift(16) - 1), middle = std::abs(lift(32) - 1),
               fine = std::abs(lift(64) - 1);
  std::cout << "lift off by " << coarse << ", " << middle << ", " << fine << "\n";
  EXPECT_LE(fine, 1e-3);
}

}  // namespace
}  // namespace tendril::contact
