#include <gtest/gtest.h>
#include <tendril/contact/rod_rod_contact.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "crossing.h"
#include "laws.h"
#include "shown.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;
using test::shown;

constexpr double kRodRange = 0.04;

constexpr double kRadius = 0.05;

/// A wavy rod with a hook at its end that comes back to it, and one that lies across both.
std::vector<std::vector<Vec3>> tangle(double apart) {
  std::vector<Vec3> hook, bar;
  const double close = 2.0 * kRadius + apart;
  for (int i = 0; i < 7; ++i) hook.emplace_back(0.2 * i, 0.01 * std::sin(2.0 * i), 0.0);
  for (const Vec3& x : {Vec3(1.45, 0, -0.15), Vec3(1.6, 0, 0.06), Vec3(1.45, 0, 0.27)}) hook.push_back(x);
  hook.emplace_back(1.2, 0.02, close);
  for (int i = 0; i < 4; ++i) hook.emplace_back(1.0 - 0.2 * i, 0.01 * std::cos(i), close + 0.003 * i);
  for (int i = 0; i < 6; ++i)
    bar.emplace_back(0.75 + 0.02 * i, 0.3 * i - 0.73, -close - 0.004 * std::abs(i - 2));
  return {hook, bar};
}

struct Tangle {
  std::vector<ContactRod> rods;
  Shown shown;
};

Tangle make_tangle(Random& random, double apart, double speed) {
  Tangle out;
  std::vector<Vec3> all;
  std::vector<NodeRange> ranges;
  for (const std::vector<Vec3>& p : tangle(apart)) {
    ranges.push_back({all.size(), p.size()});
    // At rest they are straight: what is bent together later is no neighbour.
    std::vector<Vec3> rest;
    for (std::size_t i = 0; i < p.size(); ++i)
      rest.push_back(i == 0 ? Vec3(5.0 * static_cast<double>(out.rods.size()) * Vec3::UnitZ())
                            : Vec3(rest.back() + (p[i] - p[i - 1]).norm() * Vec3::UnitX()));
    out.rods.push_back({out.rods.size(), kRadius, rest});
    all.insert(all.end(), p.begin(), p.end());
  }
  out.shown = shown(random, all, speed);
  out.shown.rods = ranges;
  for (double& spin : out.shown.spin) spin = random.uniform(-speed, speed);
  return out;
}

TEST(RodRodContact, KeepsToWhatItSaysOfItself) {
  Random random(1);
  for (const Law::Kind kind : {Law::Kind::barrier, Law::Kind::penalty})
    for (const double friction : {0.0, 0.3, 10.0})
      for (const double damping : {0.0, 0.2}) {
        SCOPED_TRACE(std::to_string(friction) + " " + std::to_string(damping));
        auto [rods, s] = make_tangle(random, 0.02, 0.5);
        const RodRodContact contact(rods, {}, law_of(kind, kRodRange, friction, damping));
        s.memory = contact.remember(s.view(), nullptr);
        ASSERT_GT(memory_of(s.memory).touches.size(), 30u);
        bool self = false, other = false;
        for (const RodTouch& touch : memory_of(s.memory).touches)
          (touch.rod[0] == touch.rod[1] ? self : other) = true;
        EXPECT_TRUE(self && other);
        for (Vec3& p : s.p) p += random.in_cube(1e-3);
        const ForceCheck check = check_force(contact, s.view(), 1e-7);
        EXPECT_TRUE(check.undeclared.empty());
        EXPECT_LT(check.derivatives, 2e-6);
        EXPECT_EQ(contact.has_energy(), friction == 0.0 && damping == 0.0);
        EXPECT_EQ(contact.twists(), friction > 0.0);
        if (contact.has_energy()) EXPECT_LT(check.energy, 1e-6);
      }
}

/// What the ledger leaves out is what has no part in it, however far all move together.
TEST(RodRodContact, IsTheSameWithALedgerAndWithout) {
  Random random(2);
  int touched = 0;
  long searches = 0, steps = 0;
  for (int round = 0; round < 60; ++round) {
    auto [rods, s] = make_tangle(random, random.uniform(0.01, 0.08), 0.5);
    const RodRodContact contact(rods, {}, law_of(Law::Kind::barrier, kRodRange, 0.0, 0.0));
    s.memory = contact.remember(s.view(), nullptr);
    for (int step = 0; step < 12; ++step) {
      const Vec3 common = random.in_cube(1.0);
      const double way = step == 7 ? 0.04 : 0.003;
      for (Vec3& p : s.p) p += common + random.in_cube(way);
      const test::Felt felt = test::same_without_memory(contact, s);
      if (felt == test::Felt::refusal) break;
      touched += felt == test::Felt::something;
      s.memory = contact.remember(s.view(), s.memory);
      ++steps;
    }
    searches += memory_of(s.memory).searches;
  }
  EXPECT_GT(touched, 100);
  EXPECT_LT(searches, steps / 2);
}

/// Forces and torques, friction's too, are in balance.
TEST(RodRodContact, KeepsMomentum) {
  Random random(3);
  for (const double friction : {0.0, 0.2, 10.0}) {
    auto [rods, s] = make_tangle(random, 0.02, 0.5);
    rods[1].radius = 0.9 * kRadius;
    const RodRodContact contact(rods, {}, law_of(Law::Kind::barrier, kRodRange, friction, 0.1));
    s.memory = contact.remember(s.view(), nullptr);
    for (Vec3& p : s.p) p += random.in_cube(1e-3);
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    contact.add(s.view(), {force, torque});
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double scale = 0.0;
    for (std::size_t i = 0; i < s.p.size(); ++i) {
      sum += force[i];
      moment += s.p[i].cross(force[i]) + torque[i];
      scale += force[i].norm();
    }
    EXPECT_GT(scale, 1e-3);
    EXPECT_LT(sum.norm(), 1e-13 * scale);
    EXPECT_LT(moment.norm(), 1e-13 * scale);
  }
}

/// A motion of all as one rigid body parts no surfaces: friction has nothing to hold.
TEST(RodRodContact, SeesNoSlidingInARigidMotion) {
  Random random(4);
  auto [rods, s] = make_tangle(random, 0.02, 0.0);
  const RodRodContact contact(rods, {}, law_of(Law::Kind::barrier, kRodRange, 0.5, 0.1));
  const Vec3 axis(0.3, -0.5, 0.8);
  const auto turn = [&](double angle) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  };
  // Directors across the edges, so that twist is none; the whole spins by 1 about the axis.
  for (std::size_t i = 0; i < s.p.size(); ++i) {
    const bool last = i + 1 == s.p.size() || i == s.rods[0].count - 1;
    s.t[i] = last ? Vec3(s.p[i] - s.p[i - 1]).normalized() : Vec3(s.p[i + 1] - s.p[i]).normalized();
    s.m[i] = s.t[i].cross(Vec3(0.1, 0.9, 0.3)).normalized();
  }
  s.memory = contact.remember(s.view(), nullptr);
  const Mat3 turned = turn(0.3);
  for (std::vector<Vec3>* of : {&s.p, &s.t, &s.m})
    for (Vec3& x : *of) x = turned * x;
  for (std::size_t i = 0; i < s.p.size(); ++i) {
    s.v[i] = axis.cross(s.p[i]);
    s.spin[i] = axis.dot(s.t[i]);
  }
  const auto after = contact.remember(s.view(), s.memory);
  ASSERT_GT(memory_of(after).touches.size(), 30u);
  double friction = 0.0, force = 0.0;
  for (const RodTouch& touch : memory_of(after).touches) {
    friction += touch.friction.norm();
    force += touch.force.norm();
  }
  EXPECT_LT(friction, 0.02 * force);
}

Scene two_rods(std::shared_ptr<const Force> contact, const Rod& a, const Rod& b) {
  Scene scene;
  scene.rods = {a, b};
  scene.forces = {std::move(contact)};
  return scene;
}

void set_velocity(State& state, std::size_t nodes, std::size_t first, std::size_t count, const Vec3& v) {
  for (std::size_t i = first; i < first + count; ++i)
    state.y.segment<3>(static_cast<Eigen::Index>(3 * (nodes + i))) = v;
}

/// Of the lines of two rods of five nodes, on the straight way from a state to another.
double distance(const State& from, const State& to, double share) {
  const auto at = [&](int k, std::size_t first) {
    const std::size_t node = first + std::min<std::size_t>(3, static_cast<std::size_t>(k) / 12);
    const double fraction = k / 12.0 - static_cast<double>(node - first);
    const auto mixed = [&](std::size_t i) {
      return Vec3(place(from, i) + share * (place(to, i) - place(from, i)));
    };
    return Vec3(mixed(node) + fraction * (mixed(node + 1) - mixed(node)));
  };
  double least = 1e300;
  for (int i = 0; i <= 48; ++i)
    for (int j = 0; j <= 48; ++j) least = std::min(least, (at(i, 0) - at(j, 5)).norm());
  return least;
}

/// A rod shot at another: never do they pass each other, whatever the speed, the angle and the steps tried.
TEST(RodRodContact, LetsNothingThroughAtAnySpeed) {
  Random random(5);
  int stopped = 0;
  const double radius = 0.01;
  for (int shot = 0; shot < 60; ++shot) {
    const double speed = std::pow(10.0, random.uniform(-1, 3)), angle = random.uniform(0.0, 3.1);
    Law law;
    law.range = 0.005;
    law.stiffness = 1e5 + 2e5 * speed * speed;
    const Rod low = test::straight_rod(4, 1e7, radius), high = crossing(4, 1e7, radius, 0.1, angle);
    auto contact = std::make_shared<RodRodContact>(
        std::vector<ContactRod>{{0, radius, low.p}, {1, radius, high.p}}, std::vector<RodJoint>{}, law);
    const System system(two_rods(contact, low, high));
    State start = system.rest_state();
    set_velocity(start, 10, 5, 5, Vec3(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), -speed));
    SimulationOptions options;
    options.first_step = 0.2 / speed;
    options.tolerance = 1e-3;
    options.energy_limit = 1.0;
    Simulation simulation(system, start, options);
    State before = start;
    double least = 1.0;
    simulation.on_progress([&](double) {
      for (int k = 1; k <= 8; ++k) least = std::min(least, distance(before, simulation.state(), k / 8.0));
      before = simulation.state();
      return true;
    });
    const Report report = simulation.run(0.4 / speed);
    EXPECT_GT(least, 2.0 * radius) << "speed " << speed << " angle " << angle << " " << report.reason;
    stopped += report.stop == Stop::finished;
  }
  EXPECT_GT(stopped, 55);
}

/// Two free rods that collide keep their energy, both momenta, and go on.
TEST(RodRodContact, KeepsEnergyAndMomentumInACollision) {
  const double radius = 0.01;
  const Rod low = test::straight_rod(8, 1e8, radius), high = crossing(8, 1e8, radius, 0.05, 1.1);
  const Law law{.stiffness = 1e5, .range = 0.005};
  auto contact = std::make_shared<RodRodContact>(
      std::vector<ContactRod>{{0, radius, low.p}, {1, radius, high.p}}, std::vector<RodJoint>{}, law);
  const System system(two_rods(contact, low, high));
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    State start = system.rest_state();
    set_velocity(start, 18, 9, 9, Vec3(0.0, 0.2, -1.0));
    SimulationOptions options;
    options.tolerance = 1e-7;
    options.method = method;
    Simulation simulation(system, start, options);
    long begun = 0;
    simulation.on_progress([&](double) {
      begun = memory_of(simulation.state().memory.at(0)).begun;
      return true;
    });
    const Report report = simulation.run(0.1);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_GT(begun, 10);
    const double off = report.last.total() - report.first.total() - report.work;
    std::cout << "energy off by " << off / report.first.total() << ", evaluations " << report.evaluations
              << "\n";
    EXPECT_LT(std::abs(off), 1e-5 * report.first.total());
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t i = 0; i < 18; ++i) {
      const double m = (i < 9 ? low.mass[i] : high.mass[i - 9]);
      momentum += m * place(simulation.state(), 18 + i);
      if (i >= 9) mass += m;
    }
    EXPECT_LT((momentum - mass * Vec3(0.0, 0.2, -1.0)).norm(), 1e-9 * mass);
  }
}

/// Parallel rods that slide along each other hardly feel where points are.
TEST(RodRodContact, IsSmoothAlongALine) {
  const std::vector<Vec3> a = test::straight(4, 1.0);
  std::vector<Vec3> rest = a;
  for (Vec3& x : rest) x += Vec3(0, 0, 1);
  const Law law = law_of(Law::Kind::barrier, kRodRange, 0.0, 0.0);
  const RodRodContact contact({{0, kRadius, a}, {1, kRadius, rest}}, {}, law);
  Random random(6);
  for (const double gap : {0.01, 0.02}) {
    double least = 1e300, most = 0.0, along = 0.0;
    for (int k = 0; k < 200; ++k) {
      std::vector<Vec3> all = a;
      for (const Vec3& x : a) all.push_back(x + Vec3(0.3 + 0.0013 * k, 0, 2.0 * kRadius + gap));
      Shown s = shown(random, all, 0.0);
      s.rods = {{0, 5}, {5, 5}};
      std::vector<Vec3> force(10, Vec3::Zero()), torque = force;
      contact.add(s.view(), {force, torque});
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = 5; i < 10; ++i) sum += force[i];
      const double length = 0.7 - 0.0013 * k;
      least = std::min(least, sum.z() / length);
      most = std::max(most, sum.z() / length);
      along = std::max(along, std::abs(sum.x()) / sum.z());
    }
    std::cout << "gap " << gap << ": normal force " << least << " to " << most << ", along at most " << along
              << "\n";
    EXPECT_LT(most - least, 0.1 * most);
  }
}

TEST(RodRodContact, LeavesOutNeighboursAlongTheRods) {
  // A zigzag with angles of 60 degrees; a branch at 30 degrees from a node; a half circle wide enough.
  const double r = 0.02;
  std::vector<Vec3> zigzag, branch, bow;
  for (int i = 0; i < 5; ++i) zigzag.emplace_back(0.1 * i, i % 2 ? 0.1732 : 0.0, 0.0);
  for (int i = 0; i < 5; ++i) branch.push_back(zigzag[2] + 0.1 * i * Vec3(0, -0.5, 0.866));
  for (int i = 0; i <= 12; ++i) {
    const double angle = std::numbers::pi * i / 12;
    bow.emplace_back(3.0 + 0.026 * std::cos(angle), 0.026 * std::sin(angle), 0.0);
  }
  const Law law{.range = 0.002};
  const std::vector<ContactRod> rods{{0, r, zigzag}, {1, r, branch}, {2, r, bow}};
  const RodRodContact contact(rods, {{{0, 1}, {2, 0}}}, law);
  Random random(7);
  std::vector<Vec3> all;
  std::vector<NodeRange> ranges;
  for (const ContactRod& rod : rods) {
    ranges.push_back({all.size(), rod.rest.size()});
    all.insert(all.end(), rod.rest.begin(), rod.rest.end());
  }
  Shown s = shown(random, all, 0.0);
  s.rods = ranges;
  EXPECT_TRUE(memory_of(contact.remember(s.view(), nullptr)).touches.empty());
  // Without the joint the branch begins within the stem.
  const RodRodContact apart(rods, {}, law);
  try {
    apart.remember(s.view(), nullptr);
    FAIL();
  } catch (const InvalidInput& refused) {
    EXPECT_EQ(refused.place(), "contact");
    EXPECT_NE(std::string(refused.what()).find("begins within rod 1 between nodes 0 and 1"),
              std::string::npos)
        << refused.what();
  }
}

TEST(RodRodContact, RefusesWhatIsNotThere) {
  const std::vector<Vec3> rest = test::straight(4, 1.0);
  const auto place_of = [&](std::vector<ContactRod> rods, const std::vector<RodJoint>& joints,
                            const Law& law) {
    try {
      const RodRodContact contact(std::move(rods), joints, law);
    } catch (const InvalidInput& refused) {
      return refused.place();
    }
    return std::string("accepted");
  };
  const ContactRod rod{0, 0.1, rest}, other{3, 0.1, rest};
  EXPECT_EQ(place_of({rod, other}, {{{0, 3}, {4, 0}}}, {}), "accepted");
  EXPECT_EQ(place_of({}, {}, {}), "contact.rods");
  EXPECT_EQ(place_of({rod}, {{{0, 3}, {4, 0}}}, {}), "contact.joints[0].rod");
  EXPECT_EQ(place_of({rod, other}, {{{0, 3}, {4, 5}}}, {}), "contact.joints[0].node");
  EXPECT_EQ(place_of({{0, std::nan(""), rest}}, {}, {}), "contact.rods[0].radius");
  EXPECT_EQ(place_of({rod}, {}, {.range = 0.0}), "contact.law.range");
  EXPECT_EQ(place_of({{0, 0.1, {Vec3::Zero()}}}, {}, {}), "contact.rods[0].rest");
}

}  // namespace
}  // namespace tendril::contact
