#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "laws.h"
#include "shown.h"
#include "support/rods.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;
using test::shown;

constexpr double kRange = 0.06;

std::vector<Vec3> wavy(double height) {
  std::vector<Vec3> p;
  for (int i = 0; i < 9; ++i)
    p.emplace_back(0.25 * i - 1.0, 0.11 * std::sin(i), height + 0.02 * std::cos(2.0 * i));
  return p;
}

Placement turned(const Vec3& position) {
  Placement at;
  at.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  at.position = position;
  at.spin = Vec3(0.3, -0.2, 0.4);
  at.velocity = Vec3(0.1, 0.2, 0.0);
  return at;
}

/// The solid brought up to the wavy rod from one side, until it comes as near as `apart`.
Collider beside(const std::string& name, ShapePtr shape, Placement at, double side, double apart) {
  const auto nearest = [&] {
    double least = 1e300;
    const std::vector<Vec3> p = wavy(0.0);
    for (std::size_t i = 0; i + 1 < p.size(); ++i)
      for (int k = 0; k <= 100; ++k)
        least = std::min(least, shape->distance(at.to_local(p[i] + 0.01 * k * (p[i + 1] - p[i]))));
    return least;
  };
  at.position.z() = 5.0 * side;
  for (double step = 4.0; step > 1e-4; step /= 2) {
    at.position.z() -= step * side;
    if (nearest() < apart) at.position.z() += step * side;
  }
  return {name, std::move(shape), at};
}

std::vector<Collider> solids() {
  return {beside("floor", half_space(), {}, -1.0, 0.08),
          beside("ball", ball(0.3), turned(Vec3(-0.4, 0.1, 0.0)), 1.0, 0.07),
          beside("box", box({0.2, 0.15, 0.1}), turned(Vec3(0.5, 0.05, 0.0)), 1.0, 0.08),
          beside("cylinder", cylinder(0.2, 0.2), turned(Vec3(0.1, 0.0, 0.0)), -1.0, 0.075)};
}

TEST(RodContact, KeepsToWhatItSaysOfItself) {
  Random random(1);
  for (const Law::Kind kind : {Law::Kind::barrier, Law::Kind::penalty})
    for (const double friction : {0.0, 0.3, 10.0})
      for (const double damping : {0.0, 0.2}) {
        SCOPED_TRACE(std::to_string(friction) + " " + std::to_string(damping));
        Shown s = shown(random, wavy(0.0), 0.5);
        RodContact contact({{0, 0.05, s.p}}, solids(), law_of(kind, kRange, friction, damping));
        s.memory = contact.remember(s.view(), nullptr);
        ASSERT_GT(static_cast<const ContactMemory&>(*s.memory).contacts.size(), 10u);
        // Moved a little, so that friction pulls.
        for (Vec3& p : s.p) p += random.in_cube(1e-3);
        const ForceCheck check = check_force(contact, s.view(), 1e-7);
        EXPECT_TRUE(check.undeclared.empty());
        EXPECT_LT(check.derivatives, 2e-6);
        EXPECT_EQ(contact.has_energy(), friction == 0.0 && damping == 0.0);
        if (contact.has_energy()) EXPECT_LT(check.energy, 1e-6);
      }
}

TEST(RodContact, ActsOnFreeBodiesAsOnRods) {
  Random random(5);
  for (const double friction : {0.0, 0.3, 10.0})
    for (const double damping : {0.0, 0.2}) {
      SCOPED_TRACE(std::to_string(friction) + " " + std::to_string(damping));
      Shown s = shown(random, wavy(0.0), 0.5);
      std::vector<Collider> all = solids();
      for (const std::size_t i : {1, 2, 3}) {
        all[i].body = s.bodies.size();
        const Placement& at = all[i].placement;
        s.bodies.push_back({at.position, at.rotation, at.velocity, at.spin, 2.0});
      }
      RodContact contact({{0, 0.05, s.p}}, all, law_of(Law::Kind::barrier, kRange, friction, damping));
      s.memory = contact.remember(s.view(), nullptr);
      ASSERT_GT(static_cast<const ContactMemory&>(*s.memory).contacts.size(), 10u);
      for (Vec3& p : s.p) p += random.in_cube(1e-3);
      const ForceCheck check = check_force(contact, s.view(), 1e-7);
      EXPECT_TRUE(check.undeclared.empty());
      EXPECT_LT(check.derivatives, 5e-6);
      if (contact.has_energy()) EXPECT_LT(check.energy, 1e-6);
    }
}

/// What the ledger leaves out is what has no part in it.
TEST(RodContact, IsTheSameWithALedgerAndWithout) {
  Random random(2);
  const std::vector<Vec3> rest = wavy(0.4);
  const RodContact contact({{0, 0.05, rest}}, solids(), law_of(Law::Kind::barrier, kRange, 0.0, 0.0));
  int touched = 0;
  for (int round = 0; round < 300; ++round) {
    Shown s = shown(random, wavy(random.uniform(0.0, 0.05)), 0.5);
    try {
      s.memory = contact.remember(s.view(), nullptr);
    } catch (const InvalidInput&) {
      continue;
    }
    for (int step = 0; step < 4; ++step) {
      for (Vec3& p : s.p) p += random.in_cube(0.003);
      const test::Felt felt = test::same_without_memory(contact, s);
      if (felt == test::Felt::refusal) break;
      touched += felt == test::Felt::something;
      s.memory = contact.remember(s.view(), s.memory);
    }
  }
  EXPECT_GT(touched, 100);
}

Scene falling(std::shared_ptr<const Force> contact, const Rod& rod, double gravity) {
  Scene scene;
  scene.rods.push_back(rod);
  scene.forces.push_back(std::move(contact));
  if (gravity != 0.0) scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -gravity)));
  return scene;
}

/// A rod of two masses and weight 1 that falls flat: one degree of freedom.
Rod bar() {
  Rod rod = test::straight_rod(1, 1e6, 0.05);
  rod.mass = {0.5, 0.5};
  return rod;
}

void set_velocity(State& state, std::size_t nodes, const Vec3& v) {
  for (std::size_t i = 0; i < nodes; ++i) state.y.segment<3>(static_cast<Eigen::Index>(3 * (nodes + i))) = v;
}

/// A rod shot at a plate: the gap is never closed, whatever the speed and the steps tried.
TEST(RodContact, LetsNothingThroughAtAnySpeed) {
  Random random(3);
  int stopped = 0;
  const std::vector<Vec3> rest = test::straight(4, 1.0);
  for (int shot = 0; shot < 100; ++shot) {
    const double thickness = 0.01, speed = std::pow(10.0, random.uniform(-1, 3));
    Law law = law_of(Law::Kind::barrier, kRange, 0.0, 0.0);
    law.range = 0.01;
    law.stiffness = 1e4 + 1e4 * speed * speed;
    const Collider plate{"plate", box({2, 2, thickness / 2}), {.position = Vec3(0, 0, -0.1)}};
    auto contact = std::make_shared<RodContact>(std::vector<ContactRod>{{0, 0.01, rest}},
                                                std::vector<Collider>{plate}, law);
    const Rod rod = test::straight_rod(4, 1e7, 0.01);
    const System system(falling(contact, rod, 0.0));
    State start = system.rest_state();
    set_velocity(start, 5, Vec3(random.uniform(-1, 1), random.uniform(-1, 1), -speed));
    SimulationOptions options;
    options.first_step = 0.2 / speed;
    options.tolerance = 1e-3;
    options.energy_limit = 1.0;
    Simulation simulation(system, start, options);
    const Report report = simulation.run(0.4 / speed);
    ASSERT_NE(report.stop, Stop::energy_lost);
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_GT(simulation.state().y[static_cast<Eigen::Index>(3 * i + 2)], -0.1 + thickness / 2 + 0.01)
          << "speed " << speed << " " << report.reason;
    stopped += report.stop == Stop::finished;
  }
  EXPECT_GT(stopped, 95);
}

/// A ball that falls on a clamped rod, bounces and falls again: nothing is lost, nothing passes.
TEST(RodContact, KeepsTheEnergyOfABallThatFallsOnARod) {
  const double radius = 0.005, mass = 0.05, size = 0.05, drop = 0.3, g = 9.81;
  const Rod rod = test::straight_rod(6, 4e9, radius, 300.0);
  Scene scene;
  scene.rods = {rod};
  scene.anchors.push_back({.rod = 0, .node = 0});
  Body ball;
  ball.mass = mass;
  ball.inertia = 0.4 * mass * size * size * Mat3::Identity();
  ball.position = Vec3(0.5, 0, size + radius + drop);
  scene.bodies = {ball};
  Collider collider{"ball", contact::ball(size), {}};
  collider.body = 0;
  const Law law{.stiffness = 1e5, .range = 0.01};
  scene.forces = {std::make_shared<RodContact>(std::vector<ContactRod>{{0, radius, rod.p}},
                                               std::vector<Collider>{collider}, law),
                  std::make_shared<Gravity>(Vec3(0, 0, -g))};
  const System system(scene);
  SimulationOptions options;
  options.tolerance = 2e-6;
  options.method = Method::rodas;
  Simulation simulation(system, system.rest_state(), options);
  double least = 1.0;
  simulation.on_progress([&](double) {
    const auto& memory = dynamic_cast<const ContactMemory&>(*simulation.state().memory.at(0));
    for (const Contact& c : memory.contacts) least = std::min(least, c.gap);
    return true;
  });
  const Report report = simulation.run(1.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const double off = report.last.total() - report.first.total() - report.work;
  std::cout << "energy off by " << off / (mass * g * drop) << " of the drop, evaluations "
            << report.evaluations << ", least gap " << least << "\n";
  EXPECT_LE(std::abs(off), 1e-5 * mass * g * drop);
  EXPECT_LT(least, 0.01);
  EXPECT_GT(least, 0.0);
}

/// A plate that rises under a rod at rest carries it along; what the plate does is work.
TEST(RodContact, FollowsWhatIsDriven) {
  const std::vector<Vec3> rest = test::straight(4, 1.0);
  Collider plate{"plate", box({2, 2, 0.01}), {}};
  plate.driven = [](double t) {
    Placement at;
    at.position = Vec3(0, 0, -0.5 + 2.0 * t);
    at.velocity = Vec3(0, 0, 2.0);
    return at;
  };
  const Law law{.stiffness = 1e6, .range = 0.01};
  auto contact = std::make_shared<RodContact>(std::vector<ContactRod>{{0, 0.01, rest}},
                                              std::vector<Collider>{plate}, law);
  EXPECT_TRUE(contact->depends_on_time());
  const System system(falling(contact, test::straight_rod(4, 1e7, 0.01), 0.0));
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    SimulationOptions options;
    options.method = method;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(0.5);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    // Hit without loss by what is far heavier, it leaves at twice the plate's speed.
    double up = 0.0;
    for (int i = 0; i < 5; ++i) {
      EXPECT_GT(simulation.state().y[3 * i + 2], 0.5 + 0.02);
      up += simulation.state().y[15 + 3 * i + 2] / 5;
    }
    EXPECT_GT(up, 3.5);
    EXPECT_GT(report.work, 0.0);
  }
}

TEST(RodContact, RefusesWhatBeginsWithinASolid) {
  const std::vector<Vec3> rest = test::straight(4, 1.0);
  auto contact = std::make_shared<RodContact>(
      std::vector<ContactRod>{{0, 0.01, rest}},
      std::vector<Collider>{{"pole", cylinder(0.1, 1.0), {.position = Vec3(0.6, 0, 0)}}}, Law{});
  const System system(falling(contact, test::straight_rod(4, 1e7, 0.01), 0.0));
  try {
    Simulation simulation(system, system.rest_state());
    FAIL();
  } catch (const InvalidInput& refused) {
    EXPECT_NE(
        std::string(refused.what()).find("rod 0 begins within collider 0 (pole): between nodes 1 and 2"),
        std::string::npos)
        << refused.what();
  }
}

TEST(RodContact, RefusesNumbersOutOfRange) {
  const std::vector<Vec3> rest = test::straight(4, 1.0);
  const std::vector<Collider> floor{{"floor", half_space(), {}}};
  const auto place = [&](std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law) {
    try {
      RodContact(std::move(rods), std::move(colliders), law);
    } catch (const InvalidInput& refused) {
      return refused.place();
    }
    return std::string("accepted");
  };
  const ContactRod rod{0, 0.1, rest};
  EXPECT_EQ(place({rod}, floor, {}), "accepted");
  EXPECT_EQ(place({}, floor, {}), "contact.rods");
  EXPECT_EQ(place({rod}, {}, {}), "contact.colliders");
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(place({{0, bad, rest}}, floor, {}), "contact.rods[0].radius");
    EXPECT_EQ(place({rod}, floor, {.stiffness = bad}), "contact.law.stiffness");
    EXPECT_EQ(place({rod}, floor, {.range = bad}), "contact.law.range");
  }
  EXPECT_EQ(place({rod}, floor, {.friction = -0.1}), "contact.law.friction");
  EXPECT_EQ(place({rod}, floor, {.damping = std::nan("")}), "contact.law.damping");
  EXPECT_EQ(place({rod}, floor, {.stick_damping = -1.0}), "contact.law.stick_damping");
  EXPECT_EQ(place({{0, 0.1, {Vec3::Zero()}}}, floor, {}), "contact.rods[0].rest");
  EXPECT_EQ(place({{0, 0.1, {Vec3::Zero(), Vec3(0, std::nan(""), 0)}}}, floor, {}), "contact.rods[0].rest");
  EXPECT_EQ(place({rod}, {{"none", nullptr, {}}}, {}), "contact.colliders[0].shape");
  EXPECT_EQ(place({rod}, {{"narrow", tube(0.1, 1, 1), {}}}, {}), "contact.colliders[0].shape");
  Placement skew;
  skew.rotation(0, 1) = 0.1;
  EXPECT_EQ(place({rod}, {{"skew", half_space(), skew}}, {}), "contact.colliders[0].placement");
  Scene scene =
      falling(std::make_shared<RodContact>(std::vector<ContactRod>{{1, 0.1, rest}}, floor, Law{}), bar(), 0);
  EXPECT_EQ(test::place_of_refusal(scene), "contact.rods[0].rod");
  scene = falling(std::make_shared<RodContact>(std::vector<ContactRod>{rod}, floor, Law{}), bar(), 0);
  EXPECT_EQ(test::place_of_refusal(scene), "contact.rods[0].rest");
}

}  // namespace
}  // namespace tendril::contact
