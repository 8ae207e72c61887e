#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "crossing.h"

namespace tendril::contact {
namespace {

/// A rod across two that are held, let go on a slope: how far it comes in a time, beginning at half of that.
struct Slope {
  double angle;
  bool along;  ///< its own axis, not that of those that hold it
  double friction;
  double damping = 0.0;  ///< of the rod's motion [1 / time]
};

double comes_in(const Slope& slope, double time) {
  const double radius = 0.01;
  const Law law{.stiffness = 2e5,
                .range = 0.002,
                .friction = slope.friction,
                .stick_stiffness = 2e6,
                .stick_damping = 0.002,
                .damping = 5.0};
  Scene scene;
  std::vector<ContactRod> rods;
  for (const double y : {-0.3, 0.3}) {
    scene.rods.push_back(moved(test::straight_rod(1, 1e7, radius), Mat3::Identity(), Vec3(0, y, 0)));
    for (std::size_t node = 0; node < 2; ++node)
      scene.anchors.push_back({.rod = scene.rods.size() - 1, .node = node});
  }
  scene.rods.push_back(crossing(2, 1e9, radius, 2 * radius + 0.00115, 0.5 * std::numbers::pi));
  scene.rods.back().mass_damping = slope.damping;
  for (std::size_t i = 0; i < 3; ++i) rods.push_back({i, radius, scene.rods[i].p});
  const Vec3 down = std::sin(slope.angle) * (slope.along ? Vec3::UnitY() : Vec3::UnitX());
  scene.forces = {std::make_shared<RodRodContact>(rods, std::vector<RodJoint>{}, law),
                  std::make_shared<Gravity>(10.0 * (down - std::cos(slope.angle) * Vec3::UnitZ()))};
  const System system(scene);
  SimulationOptions options;
  options.tolerance = 1e-4;
  Simulation simulation(system, system.rest_state(), options);
  EXPECT_EQ(simulation.run(0.5 * time).stop, Stop::finished);
  const Vec3 before = place(simulation.state(), 5);
  const Report report = simulation.run(time);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  return slope.along ? place(simulation.state(), 5).y() - before.y()
                     : place(simulation.state(), 5).x() - before.x();
}

/// Along its axis a rod stays where tan(slope) < mu, and slides with g (sin - mu cos) where it is more.
TEST(RodRodFriction, HoldsOnASlopeWhatFrictionCan) {
  const double mu = 0.5, limit = std::atan(mu), time = 0.2, from_half = 0.375 * time * time;
  const double creep = comes_in({0.9 * limit, true, mu, 40.0}, 3.0 * time);
  std::cout << "creep of " << creep << " in " << 1.5 * time << "\n";
  EXPECT_LT(std::abs(creep), 1e-6);
  const double a = 10.0 * (std::sin(1.2 * limit) - mu * std::cos(1.2 * limit));
  EXPECT_NEAR(comes_in({1.2 * limit, true, mu}, time) / from_half, a, 0.03 * a);
}

/// Across its axis it rolls, a = g sin / (1 + I / (m r^2)), while tan(slope) < mu (1 + m r^2 / I).
TEST(RodRodFriction, RollsDownASlope) {
  const double time = 0.2, from_half = 0.375 * time * time;
  const double rolls = 10.0 * std::sin(0.4) / 1.5;
  EXPECT_NEAR(comes_in({0.4, false, 0.3}, time) / from_half, rolls, 0.05 * rolls);
  const double slides = 10.0 * (std::sin(0.5) - 0.1 * std::cos(0.5));
  EXPECT_NEAR(comes_in({0.5, false, 0.1}, time) / from_half, slides, 0.04 * slides);
}

}  // namespace
}  // namespace tendril::contact
