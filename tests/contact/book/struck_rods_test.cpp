#include <gtest/gtest.h>
#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/simulation.h>

#include "memory.h"
#include "support/numbers.h"
#include "support/rods.h"

/// Rods that hit a wall and rods that are hit: what leaves, and when.
namespace tendril::contact {
namespace {

using tendril::test::kPi;
using test::memory_of;

/// When a rod that met a wall end-on comes off it, over L / c, and with what momentum, over m V.
struct Rebound {
  double release, momentum;
};

/// A rod of E A = rho A = 1 along x whose end rests at the edge of the wall's range while all others come at
/// it with V, as if it had stuck there.
Rebound rebound(int edges, Law law) {
  const double radius = 0.05, area = kPi * radius * radius, speed = 1e-3;
  Rod rod = tendril::test::straight_rod(edges, 1.0 / area, radius, 1.0 / area);
  const auto scene_at = [&](double wall) {
    const Collider solid{"wall",
                         half_space(),
                         {.rotation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()).toRotationMatrix(),
                          .position = Vec3(wall, 0, 0)}};
    Scene scene;
    scene.rods = {rod};
    scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                                 std::vector<Collider>{solid}, law)};
    return scene;
  };
  // The gap is taken a little smaller than it is: by how much is read off.
  double wall = -radius - 0.9 * law.range;
  for (int k = 0; k < 3; ++k) {
    const System system(scene_at(wall));
    const Simulation simulation(system, system.rest_state(), {});
    const std::vector<Contact> contacts = memory_of(simulation.state()).contacts;
    if (contacts.empty()) break;
    wall -= law.range * (1.0 - 1e-12) - contacts[0].gap;
  }
  const System system(scene_at(wall));
  State start = system.rest_state();
  const auto n = static_cast<Eigen::Index>(edges) + 1;
  for (Eigen::Index i = 1; i < n; ++i) start.y[3 * (n + i)] = -speed;
  SimulationOptions options;
  options.tolerance = 1e-11;
  options.method = Method::cash_karp;
  Simulation simulation(system, start, options);
  Rebound out{0.0, 0.0};
  // It comes off where its first edge is as long as at rest.
  double before = 0.0, longer_before = 0.0;
  simulation.on_progress([&](double) {
    const State& state = simulation.state();
    const double longer = state.y[3] - state.y[0] - 1.0 / edges;
    if (longer_before < 0.0 && longer >= 0.0 && out.release == 0.0)
      out.release = before + (state.time - before) * longer_before / (longer_before - longer);
    before = state.time, longer_before = longer;
    return true;
  });
  const Report report = simulation.run(2.2);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_TRUE(memory_of(simulation.state()).contacts.empty());
  for (Eigen::Index i = 0; i < n; ++i)
    out.momentum += rod.mass[static_cast<std::size_t>(i)] * simulation.state().y[3 * (n + i)] / speed;
  return out;
}

TEST(ContactBook, ARodMeetsAWallEndOn) {
  for (const auto& [edges, release, momentum] :
       {std::tuple(8, 2.054765, 0.914567), std::tuple(32, 2.024207, 0.969695)}) {
    const Rebound found =
        rebound(edges, {.kind = Law::Kind::penalty, .stiffness = 1e7 * edges, .range = 1e-4});
    std::cout << "end-on, " << edges << " edges: release off by " << found.release - release
              << ", momentum by " << found.momentum - momentum << "\n";
    EXPECT_NEAR(found.release, release, 1e-6);
    EXPECT_NEAR(found.momentum, momentum, 1e-6);
  }
}

/// v / V at a time of a mass that landed on a long beam of B = m = 1 and stays on it: e^(a^2 t) erfc(a
/// sqrt(t)), a = 2 sqrt(2) (B m^3)^(1/4) / M = 1/2.
double landed(int edges, double length, double time) {
  const double speed = 3e-3;
  const Law law{.stiffness = 1e7, .range = 1e-5, .damping = 1e4};
  const double radius = 0.02, inertia = kPi * std::pow(radius, 4) / 4, area = kPi * radius * radius;
  const double ball_radius = 0.1;
  std::vector<Vec3> p, q;
  for (int i = 0; i <= edges; ++i) {
    p.emplace_back(length * (static_cast<double>(i) / edges - 0.5), 0, 0);
    q.push_back(p.back() + 0.1 * Vec3::UnitY());
  }
  const Rod rod = make_rod(p, q, {1.0 / inertia, 1.0 / inertia / 3, 1.0 / area}, circular_section(radius));
  Scene scene;
  scene.rods = {rod};
  Body body;
  body.mass = 4.0 * std::sqrt(2.0);
  body.inertia = 0.4 * body.mass * ball_radius * ball_radius * Mat3::Identity();
  body.position = Vec3(0, 0, radius + ball_radius + law.range);
  body.velocity = Vec3(0, 0, -speed);
  scene.bodies = {body};
  Collider collider{"mass", ball(ball_radius), {}};
  collider.body = 0;
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                               std::vector<Collider>{collider}, law)};
  const System system(scene);
  SimulationOptions options;
  options.tolerance = 1e-8;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(time);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_FALSE(memory_of(simulation.state()).contacts.empty());
  return -system.bodies(simulation.state())[0].velocity.z() / speed;
}

TEST(ContactBook, AMassLandsOnALongBeam) {
  // Beams so long that what their ends throw back is not there yet.
  const double exact_early = 0.615690, exact_late = 0.427584;
  const auto early = [&](int edges) { return std::abs(landed(edges, 16.0, 1.0) / exact_early - 1.0); };
  const double coarse = early(32), fine = early(64);
  const double late = std::abs(landed(64, 40.0, 4.0) / exact_late - 1.0);
  std::cout << "landed, off by " << coarse << ", " << fine << " and " << late << "\n";
  EXPECT_LE(fine, 1e-3);
  EXPECT_GE(std::log2(coarse / fine), 1.8);
  EXPECT_LE(late, 1e-3);
}

}  // namespace
}  // namespace tendril::contact
