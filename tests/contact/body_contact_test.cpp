#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/contact/body_contact.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <numbers>

#include "shown.h"
#include "support/rods.h"

namespace tendril::contact {
namespace {

constexpr double kGravity = 9.81;

/// A scene of bodies alone, but for a rod far away that a scene has to have.
struct Bodies {
  Scene scene;
  std::vector<Collider> colliders;

  explicit Bodies(double floor) {
    Rod rod = test::straight_rod(1, 1e4, 0.05);
    scene.rods = {rod};
    for (const std::size_t node : {0, 1}) scene.anchors.push_back({.rod = 0, .node = node});
    colliders.push_back({"floor", half_space(), {.position = Vec3(0, 0, floor)}});
  }
  Body& add(ShapePtr shape, double mass, const Vec3& moments, const Vec3& position) {
    Body body;
    body.mass = mass;
    body.inertia = moments.asDiagonal();
    body.position = position;
    Collider collider{"", std::move(shape), {}};
    collider.body = scene.bodies.size();
    colliders.push_back(collider);
    scene.bodies.push_back(body);
    return scene.bodies.back();
  }
  Body& add_ball(double radius, double mass, const Vec3& position) {
    return add(ball(radius), mass, Vec3::Constant(0.4 * mass * radius * radius), position);
  }
  System system(const Law& law, const Vec3& gravity) {
    scene.forces = {std::make_shared<BodyContact>(colliders, law), std::make_shared<Gravity>(gravity)};
    return System(scene);
  }
};

const BodyMemory& body_memory_of(const Simulation& simulation) {
  return dynamic_cast<const BodyMemory&>(*simulation.state().memory.at(0));
}

SimulationOptions within(double tolerance, Method method = Method::cash_karp) {
  SimulationOptions options;
  options.tolerance = tolerance;
  options.method = method;
  return options;
}

TEST(BodyContact, ABallBouncesForEverAtTheSameHeight) {
  Bodies bodies(0.0);
  bodies.add_ball(0.1, 2.0, Vec3(0, 0, 0.6));
  const System system = bodies.system({.stiffness = 1e6, .range = 0.01}, Vec3(0, 0, -kGravity));
  Simulation simulation(system, system.rest_state(), within(1e-10));
  double highest = 0.0, lowest = 1.0;
  simulation.on_progress([&](double t) {
    const BodyView now = system.bodies(simulation.state())[0];
    lowest = std::min(lowest, now.position.z());
    // The top of the flight that it is on.
    const double top = now.position.z() + std::pow(now.velocity.z(), 2) / (2.0 * kGravity);
    if (t > 1.0 && body_memory_of(simulation).touches.empty()) highest = std::max(highest, top);
    return true;
  });
  const Report report = simulation.run(3.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_NEAR(highest, 0.6, 1e-6);
  EXPECT_GT(lowest, 0.1);
  EXPECT_NEAR(report.last.total(), report.first.total(),
              1e-7 * std::abs(report.first.kinetic + 2.0 * kGravity * 0.5));
}

/// Balls that touch each other or the floor couple, at a state, with what they touch and nothing else.
TEST(BodyContact, SaysWhatActsAtAState) {
  test::Random random(3);
  Bodies bodies(0.0);
  const double reach = 0.2 + 0.4e-3;
  for (const Vec3& at :
       {Vec3(0, 0, 0.1 + 0.4e-3), Vec3(reach, 0, 0.5), Vec3(2 * reach, 0, 0.5), Vec3(5, 0, 0.5)})
    bodies.add_ball(0.1, 1.0, at);
  const BodyContact contact(bodies.colliders,
                            {.stiffness = 1e5, .range = 1e-3, .friction = 0.3, .damping = 0.1});
  test::Shown s = test::shown(random, {Vec3(9, 9, 9), Vec3(9, 9, 9.1)}, 0.1);
  for (const Body& body : bodies.scene.bodies)
    s.bodies.push_back({body.position, Mat3::Identity(), random.in_cube(0.1), random.in_cube(0.5), 1.0});
  s.memory = contact.remember(s.view(), nullptr);
  for (BodyView& body : s.bodies) body.position += random.in_cube(5e-5);
  s.memory = contact.remember(s.view(), s.memory);
  const ForceCheck check = check_force(contact, s.view(), 1e-7);
  EXPECT_TRUE(check.undeclared.empty());
  const LocalCouplings local = contact.couplings_with_bodies(s.rods, 4).local()(s.view());
  const std::vector<Couplings::Pair> expected{{2, 3}, {4, 5}, {4, 6}, {4, 7}, {5, 6}, {5, 7}, {6, 7}};
  EXPECT_EQ(local.pairs, expected);
}

/// A ball that slides begins to roll: at 5/7 of its speed, after 2 v / (7 mu g).
TEST(BodyContact, ASlidingBallComesToRoll) {
  const double mu = 0.2, speed = 1.0, radius = 0.1, mass = 1.0;
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    Bodies bodies(0.0);
    const Law law{
        .stiffness = 2e5, .range = 1e-3, .friction = mu, .stick_stiffness = 2e5, .stick_damping = 2e-3};
    double gap = 0.5e-3;
    for (int i = 0; i < 60; ++i) {
      const Potential b = potential(law, gap);
      gap -= (-0.2 * law.stiffness * b.slope - mass * kGravity) / (-0.2 * law.stiffness * b.bend);
    }
    Body& ball = bodies.add_ball(radius, mass, Vec3(0, 0, radius + gap));
    ball.velocity = Vec3(speed, 0, 0);
    const System system = bodies.system(law, Vec3(0, 0, -kGravity));
    Simulation simulation(system, system.rest_state(), within(1e-7, method));
    const double rolls = 2.0 * speed / (7.0 * mu * kGravity);
    Report report = simulation.run(0.9 * rolls);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    BodyView now = system.bodies(simulation.state())[0];
    EXPECT_NEAR(now.velocity.x(), speed - mu * kGravity * 0.9 * rolls, 1e-3);
    EXPECT_FALSE(body_memory_of(simulation).touches.at(0).sticks);
    report = simulation.run(3.0 * rolls);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    now = system.bodies(simulation.state())[0];
    EXPECT_NEAR(now.velocity.x(), 5.0 / 7.0 * speed, 3e-3);
    EXPECT_NEAR(now.spin.y() * radius, now.velocity.x(), 3e-3);
    EXPECT_TRUE(body_memory_of(simulation).touches.at(0).sticks);
  }
}

/// What bounces as it slides begins a contact at each bounce. Friction takes from the beginning of each mu of
/// what the normal force gives: v_x = g t sin - mu (v_z + g t cos).
TEST(BodyContact, ABallThatBouncesDownASlopeIsHeldBackByMuTimesWhatThrowsItUp) {
  const double mu = 0.05, angle = 0.35, radius = 0.05;
  for (const double tolerance : {1e-4, 1e-6}) {
    Bodies bodies(0.0);
    bodies.add_ball(radius, 0.1, Vec3(0, 0, radius + 2e-3));
    const Vec3 gravity = kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
    const System system =
        bodies.system({.stiffness = 2e4, .range = 1e-3, .friction = mu, .stick_stiffness = 2e6}, gravity);
    Simulation simulation(system, system.rest_state(), within(tolerance));
    const double t = 1.5;
    const Report report = simulation.run(t);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    const Vec3 v = system.bodies(simulation.state())[0].velocity;
    EXPECT_NEAR(v.x(), gravity.x() * t - mu * (v.z() - gravity.z() * t), 1e-9) << tolerance;
    EXPECT_EQ(v.y(), 0.0);
  }
}

/// Two equal balls that meet head on exchange their velocities, far from anything else; a third that they
/// miss stays.
TEST(BodyContact, BallsExchangeTheirVelocities) {
  Bodies bodies(-10.0);
  bodies.add_ball(0.1, 1.0, Vec3(-0.5, 0, 0)).velocity = Vec3(3, 0, 0);
  bodies.add_ball(0.1, 1.0, Vec3(0.5, 0, 0)).velocity = Vec3(-1, 0, 0);
  bodies.add(capsule(0.2, 0.05), 1.0, Vec3(1, 1, 0.1), Vec3(0, 2, 0));
  const System system = bodies.system({.stiffness = 1e6, .range = 0.01}, Vec3::Zero());
  Simulation simulation(system, system.rest_state(), within(1e-9));
  std::size_t most = 0;  // each pair is met once
  simulation.on_progress([&](double) {
    most = std::max(most, body_memory_of(simulation).touches.size());
    return true;
  });
  const Report report = simulation.run(1.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_EQ(most, 1u);
  const std::vector<BodyView> now = system.bodies(simulation.state());
  EXPECT_NEAR(now[0].velocity.x(), -1.0, 1e-6);
  EXPECT_NEAR(now[1].velocity.x(), 3.0, 1e-6);
  EXPECT_EQ(now[2].velocity, Vec3::Zero());
}

/// A box that stands on a slope below the angle of friction stays where it is.
TEST(BodyContact, ABoxStandsOnASlopeAndOneTooSteepSlides) {
  for (const double share : {0.9, 1.2}) {
    Bodies bodies(0.0);
    const double mu = 0.4, angle = std::atan(share * mu);
    bodies.add(box({0.2, 0.2, 0.05}), 1.0, Vec3(0.02, 0.02, 0.03), Vec3(0, 0, 0.05 + 5e-4));
    const Law law{.stiffness = 1e7, .range = 1e-3, .friction = mu, .stick_damping = 1e-3, .damping = 50.0};
    const System system = bodies.system(law, kGravity * Vec3(std::sin(angle), 0, -std::cos(angle)));
    Simulation simulation(system, system.rest_state(), within(1e-6, Method::automatic));
    Report report = simulation.run(1.5);  // it has come to rest
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_EQ(body_memory_of(simulation).touches.size(), 4u);
    const BodyView before = system.bodies(simulation.state())[0];
    report = simulation.run(2.5);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    const BodyView after = system.bodies(simulation.state())[0];
    if (share < 1.0)
      EXPECT_LT((after.position - before.position).norm(), 1e-10);
    else
      EXPECT_NEAR(after.velocity.x() - before.velocity.x(),
                  kGravity * (std::sin(angle) - mu * std::cos(angle)), 1e-6);
  }
}

TEST(BodyContact, RefusesWhatItCannotKeepApart) {
  const auto refusal = [](const Bodies& bodies) -> std::string {
    try {
      const BodyContact contact(bodies.colliders, {});
    } catch (const InvalidInput& refused) {
      return refused.what();
    }
    return "accepted";
  };
  Bodies bodies(0.0);
  EXPECT_NE(refusal(bodies).find("no free body"), std::string::npos);
  bodies.add(box({1, 1, 1}), 1, Vec3::Ones(), Vec3::Zero());
  EXPECT_EQ(refusal(bodies), "accepted");
  bodies.add(cylinder(1, 1), 1, Vec3::Ones(), Vec3::Zero());
  EXPECT_NE(refusal(bodies).find("a body with edges could meet collider 2"), std::string::npos)
      << refusal(bodies);
  Bodies within_floor(0.0);
  within_floor.add_ball(0.1, 1.0, Vec3(0, 0, 0.05));
  const System system = within_floor.system({}, Vec3::Zero());
  try {
    Simulation simulation(system, system.rest_state());
    FAIL();
  } catch (const InvalidInput& refused) {
    EXPECT_NE(std::string(refused.what()).find("collider 1 begins within collider 0 (floor)"),
              std::string::npos)
        << refused.what();
  }
}

}  // namespace
}  // namespace tendril::contact
