#include <gtest/gtest.h>
#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include "memory.h"
#include "support/numbers.h"
#include "support/rods.h"

/// References for contact with known digits: one degree of freedom in a potential, friction, beams on
/// supports.
namespace tendril::contact {
namespace {

using tendril::test::kPi;
using test::memory_of;

Vec3 place(const State& state, std::size_t node) {
  return state.y.segment<3>(static_cast<Eigen::Index>(3 * node));
}
Vec3 velocity(const State& state, std::size_t nodes, std::size_t node) {
  return place(state, nodes + node);
}
void set_velocity(State& state, std::size_t nodes, const Vec3& v) {
  for (std::size_t i = 0; i < nodes; ++i) state.y.segment<3>(static_cast<Eigen::Index>(3 * (nodes + i))) = v;
}

/// A rod of two masses of 1/2 and of weight 1 that moves as one.
Rod bar() {
  Rod rod = tendril::test::straight_rod(1, 1e4, 0.05);
  rod.mass = {0.5, 0.5};
  return rod;
}

/// \param floors  on each other
std::shared_ptr<RodContact> on_floor(const Rod& rod, double radius, double height, const Law& law,
                                     std::size_t floors = 1) {
  const Collider floor{"floor", half_space(), {.position = Vec3(0, 0, height)}};
  return std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                      std::vector<Collider>(floors, floor), law);
}

SimulationOptions within(double tolerance, Method method = Method::cash_karp) {
  SimulationOptions options;
  options.tolerance = tolerance;
  options.method = method;
  return options;
}

struct Bounce {
  double time;   ///< within the range
  double least;  ///< gap
  double speed;  ///< afterwards
};

/// A mass of 1 that meets a floor with speed 1, from 1/10 above its range.
Bounce bounce(const Law& law) {
  const Rod rod = bar();
  Scene scene;
  scene.rods = {rod};
  const double radius = 0.1, above = 0.1;
  scene.forces = {on_floor(rod, radius, -radius - law.range - above, law)};
  const System system(scene);
  State start = system.rest_state();
  set_velocity(start, 2, Vec3(0, 0, -1));
  SimulationOptions options = within(1e-12);
  options.largest_step = 2e-5;
  Simulation simulation(system, start, options);
  Bounce result{0.0, law.range, 0.0};
  // The parabola through a state's place and speed, bent by the force there, has its lowest point here.
  simulation.on_progress([&](double) {
    const ContactMemory& memory = memory_of(simulation.state());
    if (memory.contacts.empty()) return true;
    double force = 0.0;
    for (const Contact& c : memory.contacts) force += c.force.z();
    const double v = velocity(simulation.state(), 2, 0).z();
    const double gap = memory.contacts[0].gap, fall = v * v / (2.0 * force);
    if (fall < 1e-5 * gap) result.least = std::min(result.least, gap - fall);
    return true;
  });
  const double end = 0.4;
  const Report report = simulation.run(end);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  result.speed = velocity(simulation.state(), 2, 0).z();
  result.time = end - above - (place(simulation.state(), 0).z() + above) / result.speed;
  return result;
}

TEST(ContactBook, OneDegreeOfFreedomAgainstABarrier) {
  for (const auto& [kappa, least, time] :
       {std::tuple(1e4, 3.291860e-3, 1.789636e-2), std::tuple(1e6, 8.340216e-3, 4.621420e-3)}) {
    const Bounce found = bounce({.stiffness = kappa, .range = 0.01});
    EXPECT_NEAR(found.least, least, 1e-6 * 0.01);
    EXPECT_NEAR(found.time, time, 1e-6 * time);
    EXPECT_NEAR(found.speed, 1.0, 1e-9);
  }
}

TEST(ContactBook, OneDegreeOfFreedomAgainstASpring) {
  for (const double k : {1e4, 1e6}) {
    const Bounce found = bounce({.kind = Law::Kind::penalty, .stiffness = k, .range = 0.01});
    EXPECT_NEAR(found.time, kPi / std::sqrt(k), 1e-6 * kPi / std::sqrt(k));
    EXPECT_NEAR(found.speed, 1.0, 1e-9);
  }
}

/// Block on a slope of which the tangent is a share of the friction: it holds, or slides by what is left.
struct Slope {
  double creep;  ///< [length / time]
  double slip;   ///< way after a second
  bool sticks;
};
/// \param floors  that lie on each other and carry it together
Slope on_slope(double friction, double share, double duration, std::size_t floors = 1) {
  const Rod rod = bar();
  const double angle = std::atan(share * friction), g = 9.81;
  Law law{.stiffness = 1e4, .range = 0.01, .friction = friction, .damping = 30.0};
  Scene scene;
  scene.rods = {rod};
  scene.rods[0].mass_damping = 5.0;
  scene.forces = {on_floor(rod, 0.1, -0.1 - 0.005, law, floors),
                  std::make_shared<Gravity>(g * Vec3(std::sin(angle), 0, -std::cos(angle)))};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), within(1e-8, Method::automatic));
  const std::vector<double> outputs{duration / 2, duration};
  Report report = simulation.run(duration / 2);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  const double before = place(simulation.state(), 0).x();
  report = simulation.run(duration);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  const double after = place(simulation.state(), 0).x();
  const ContactMemory& memory = memory_of(simulation.state());
  return {(after - before) / (duration / 2), after,
          !memory.contacts.empty() && std::all_of(memory.contacts.begin(), memory.contacts.end(),
                                                  [](const Contact& c) { return c.sticks; })};
}

TEST(ContactBook, WhatSticksDoesNotCreep) {
  const Slope held = on_slope(0.5, 0.95, 60.0);
  EXPECT_TRUE(held.sticks);
  EXPECT_LE(std::abs(held.creep), 1e-12);
  // Nor does what two solids hold at once; it takes longer to come to rest.
  const Slope between = on_slope(0.5, 0.95, 240.0, 2);
  EXPECT_TRUE(between.sticks);
  EXPECT_LE(std::abs(between.creep), 1e-12);
  const Slope slid = on_slope(0.5, 1.05, 2.0);
  EXPECT_FALSE(slid.sticks);
  EXPECT_GT(slid.slip, 0.01);
}

/// A mass on a spring k that friction brakes: from 10.3 mu N / k it comes to rest at -0.3 mu N / k, after
/// five half periods.
TEST(ContactBook, FrictionBringsASpringToRestOffItsMiddle) {
  const Rod rod = bar();
  const double mu = 0.2, g = 10.0, k = 50.0, unit = mu * g / k, omega = std::sqrt(k);
  Law law{.stiffness = 1e5, .range = 0.001, .friction = mu, .stick_stiffness = 1e7};
  // Begins where the floor carries it.
  double gap = 0.0005;
  for (int i = 0; i < 60; ++i) {
    const Potential b = potential(law, gap);
    gap -= (-law.stiffness * b.slope - g) / (-law.stiffness * b.bend);
  }
  Scene scene;
  scene.rods = {rod};
  scene.forces = {on_floor(rod, 0.1, -0.1 - gap, law), std::make_shared<Gravity>(Vec3(0, 0, -g)),
                  std::make_shared<PullTowards>(0, 0, Vec3(-10.3 * unit, 0, 0), k / 2),
                  std::make_shared<PullTowards>(0, 1, Vec3(1.0 - 10.3 * unit, 0, 0), k / 2)};
  const System system(scene);
  Simulation simulation(system, system.rest_state(), within(1e-9));
  const double rest = 15.70796 / omega;
  Report report = simulation.run(0.98 * rest);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_LT(velocity(simulation.state(), 2, 0).x(), -1e-4);  // still on its way
  report = simulation.run(1.2 * rest);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(place(simulation.state(), 0).x(), -10.6 * unit, 1e-3 * unit);
  EXPECT_TRUE(memory_of(simulation.state()).contacts.at(0).sticks);
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
  scene.forces = {on_floor(rod, 0.01, -h - 0.01 - gap, law), std::make_shared<Gravity>(Vec3(0, 0, -1.0))};
  const System system(scene);
  const Equilibrium found = find_equilibrium(system, system.rest_state());
  EXPECT_EQ(found.balance, Balance::converged) << found.reason;
  EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
  return found.support[0].z();
}

TEST(ContactBook, AHeavyCantileverLiesDownAlongALine) {
  const double exact = 2.0 / 3.0 * std::pow(72.0 / 200.0, 0.25);
  const auto off = [&](int edges) { return std::abs(clamp_force(edges, 1e-6) / exact - 1.0); };
  EXPECT_LE(off(64), 1e-3);
  EXPECT_GE(std::log2(off(16) / off(32)), 1.8);
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
  const Equilibrium found = find_equilibrium(system, system.rest_state(), {.until = 1.0});
  EXPECT_EQ(found.balance, Balance::converged) << found.reason;
  const Vec3 push = -found.support[0], at = below.driven(1.0).position;
  const double angle = std::atan2(std::abs(push.x()), push.z());
  double nearest = 1e9, arm = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(edges); ++i)
    for (int k = 0; k <= 1000; ++k) {
      const Vec3 x = place(found.state, i) + 1e-3 * k * (place(found.state, i + 1) - place(found.state, i));
      if ((x - at).norm() < nearest) nearest = (x - at).norm(), arm = x.x();
    }
  EXPECT_GT(angle, kPi / 6);
  return 2.0 * push.z() * arm * arm / bending / three_points(angle) - 1.0;
}

TEST(ContactBook, ABeamBendsOverSupportsThatItSlidesOn) {
  EXPECT_NEAR(three_points(kPi / 6), 1.577869, 1e-6);
  EXPECT_NEAR(three_points(38.30121 * kPi / 180), 1.667952, 1e-6);
  const double coarse = off_three_points(32, 0.4), fine = off_three_points(64, 0.4);
  std::cout << "three points: " << coarse << " " << fine << "\n";
  EXPECT_NEAR(fine, 0.0, 1e-3);
}

/// A rod on a rough floor drawn at its end by F gives way by F^2 / (2 E A mu q); the rest of it sticks.
TEST(ContactBook, ARodDrawnOverARoughFloorGivesWayAsFarAsFrictionLets) {
  const double mu = 0.5, weight = 4.0, pull = 1.0, tension = 100.0, radius = 0.02;
  const auto given_way = [&](int edges) {
    Rod rod = tendril::test::straight_rod(edges, 1.0, radius);
    const double area = kPi * radius * radius;
    rod =
        make_rod(rod.p, rod.q, {tension / area, tension / area / 3, weight / area}, circular_section(radius));
    rod.mass_damping = 20.0;
    Law law{.stiffness = 1.0, .range = 1e-3, .friction = mu, .stick_stiffness = 1e7};
    law.stiffness = weight / -potential({.stiffness = 1.0, .range = 1e-3}, 5e-4).slope;
    Scene scene;
    scene.rods = {rod};
    scene.forces = {on_floor(rod, radius, -radius - 5e-4, law), std::make_shared<Gravity>(Vec3(0, 0, -1)),
                    std::make_shared<PointLoad>(PointLoad::Kind::force, 0, static_cast<std::size_t>(edges),
                                                Vec3(pull, 0, 0), Signal::table({{0.0, 0.0}, {20.0, 1.0}}))};
    const System system(scene);
    Simulation simulation(system, system.rest_state(), within(1e-6, Method::rodas));
    const Report report = simulation.run(21.0);
    EXPECT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_TRUE(memory_of(simulation.state()).contacts.front().sticks);
    return place(simulation.state(), static_cast<std::size_t>(edges)).x() - 1.0;
  };
  const double exact = pull * pull / (2.0 * tension * mu * weight);
  EXPECT_NEAR(given_way(16), exact, 1e-3 * exact);
}

}  // namespace
}  // namespace tendril::contact
