#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/curve/frames.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/exact/surface.h>

#include "laws.h"
#include "leaf.h"
#include "shown.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Shown;
using test::shown_of;
using test::stalks;

constexpr double kSkin = 0.01, kRange = 0.03;

std::vector<Collider> solids() {
  Placement turned{.position = Vec3(0.75, 0.03, 0.155)};
  turned.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  return {{"floor", half_space(), {.position = Vec3(0, 0, -0.05)}},
          {"ball", ball(0.2), {.position = Vec3(0.3, 0.05, 0.24)}},
          {"capsule", capsule(0.1, 0.04), turned}};
}

SurfaceContact contact_on(const std::vector<Rod>& rods, std::vector<Collider> with, const Law& law) {
  return {test::surface_on(rods, test::leaf(1.0, 0.2, 16, 4), kSkin), std::move(with), law};
}

TEST(SurfaceContact, KeepsToWhatItSaysOfItself) {
  Random random(1);
  const std::vector<Rod> rods = stalks();
  for (const Law::Kind kind : {Law::Kind::barrier, Law::Kind::penalty}) {
    SCOPED_TRACE(kind == Law::Kind::barrier ? "barrier" : "penalty");
    Shown s = shown_of(rods, random, 0.002, 0.5);
    const SurfaceContact contact = contact_on(rods, solids(), law_of(kind, kRange, 0.0, 0.0));
    s.memory = contact.remember(s.view(), nullptr);
    ASSERT_GT(static_cast<const SurfaceMemory&>(*s.memory).touches.size(), 10u);
    for (Vec3& p : s.p) p += random.in_cube(1e-4);
    const ForceCheck check = check_force(contact, s.view(), 1e-6);
    EXPECT_TRUE(check.undeclared.empty());
    EXPECT_LT(check.local, 1e-12);
    ASSERT_TRUE(contact.has_energy());
    EXPECT_LT(check.energy, 2e-6);
  }
}

TEST(SurfaceContact, ActsOnFreeBodiesAsOnTheSurface) {
  Random random(5);
  const std::vector<Rod> rods = stalks();
  Shown s = shown_of(rods, random, 0.002, 0.5);
  std::vector<Collider> all = solids();
  for (const std::size_t i : {1, 2}) {
    all[i].body = s.bodies.size();
    const Placement& at = all[i].placement;
    s.bodies.push_back({at.position, at.rotation, at.velocity, at.spin, 2.0});
  }
  for (const double friction : {0.0, 0.4}) {
    const SurfaceContact contact =
        contact_on(rods, all, law_of(Law::Kind::barrier, kRange, friction, friction));
    s.memory = contact.remember(s.view(), nullptr);
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    std::vector<Wrench> wrench(2);
    for (Vec3& p : s.p) p += random.in_cube(1e-4);
    contact.add(s.view(), {force, torque, nullptr, wrench});
    const ForceCheck check = check_force(contact, s.view(), 1e-6);
    EXPECT_TRUE(check.undeclared.empty());
    EXPECT_LT(check.local, 1e-12);
    if (contact.has_energy()) EXPECT_LT(check.energy, 2e-6);
    // The floor aside, nothing comes from outside: not with the floor out of reach.
    std::vector<Collider> bodies(all.begin() + 1, all.end());
    const SurfaceContact alone =
        contact_on(rods, bodies, law_of(Law::Kind::barrier, kRange, friction, friction));
    s.memory = alone.remember(s.view(), nullptr);
    std::fill(force.begin(), force.end(), Vec3::Zero());
    std::fill(torque.begin(), torque.end(), Vec3::Zero());
    std::fill(wrench.begin(), wrench.end(), Wrench{});
    for (Vec3& p : s.p) p += random.in_cube(1e-4);
    alone.add(s.view(), {force, torque, nullptr, wrench});
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double scale = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      sum += force[i];
      moment += s.p[i].cross(force[i]) + torque[i];
      scale += force[i].norm();
    }
    for (std::size_t b = 0; b < 2; ++b) {
      sum += wrench[b].force;
      moment += s.bodies[b].position.cross(wrench[b].force) + wrench[b].torque;
    }
    ASSERT_GT(scale, 0.0);
    EXPECT_LT(sum.norm(), 1e-12 * scale);
    EXPECT_LT(moment.norm(), 1e-12 * scale);
  }
}

/// What the ledger and the patches leave out is what has no part in it.
TEST(SurfaceContact, IsTheSameWithALedgerAndWithout) {
  Random random(2);
  const std::vector<Rod> rods = stalks();
  const SurfaceContact contact = contact_on(rods, solids(), law_of(Law::Kind::barrier, kRange, 0.0, 0.0));
  int touched = 0, untouched = 0;
  for (int round = 0; round < 90; ++round) {
    Shown s = shown_of(rods, random, 0.005, 0.5);
    for (Vec3& p : s.p)
      p.z() += round % 2 == 0 ? random.uniform(-0.01, 0.05) : random.uniform(0.0, 0.03) + 4.0;
    try {
      s.memory = contact.remember(s.view(), nullptr);
    } catch (const InvalidInput&) {
      continue;
    }
    for (int step = 0; step < 4; ++step) {
      for (Vec3& p : s.p) p += random.in_cube(0.002);
      const test::Felt felt = test::same_without_memory(contact, s);
      if (felt == test::Felt::refusal) break;
      ++(felt == test::Felt::something ? touched : untouched);
      s.memory = contact.remember(s.view(), s.memory);
    }
  }
  EXPECT_GT(touched, 30);
  EXPECT_GT(untouched, 10);
  std::cout << touched << " touched, " << untouched << " not\n";
}

/// A leaf on its rod, clamped at its foot, and a ball above it.
struct Drop {
  Scene scene;
  ContactSurface surface;
  double radius = 0.05, mass = 0.02, height = 0.2, g = 9.81;

  explicit Drop(const Law& law) {
    const Rod rod = test::straight_rod(8, 1e8, 0.012, 400.0);
    surface = test::surface_on({rod}, test::leaf(1.0, 0.15, 30, 6), 0.004);
    scene.rods = {rod};
    scene.anchors.push_back({.rod = 0, .node = 0});
    Body ball;
    ball.mass = mass;
    ball.inertia = 0.4 * mass * radius * radius * Mat3::Identity();
    ball.position = Vec3(0.55, 0.04, radius + surface.skin + height);
    scene.bodies = {ball};
    Collider collider{"ball", contact::ball(radius), {}};
    collider.body = 0;
    scene.forces = {std::make_shared<SurfaceContact>(surface, std::vector<Collider>{collider}, law),
                    std::make_shared<Gravity>(Vec3(0, 0, -g))};
  }
};

/// Holds the ball against the mesh of accepted states, exactly.
class ExactLeaf {
 public:
  ExactLeaf(const ContactSurface& surface, const System& system)
      : surface_(surface), system_(system), work_(system.make_workspace()), at_(surface.rest.size()) {
    for (const auto& t : surface.triangles) corners_.insert(corners_.end(), t.begin(), t.end());
    for (std::uint32_t i = 0; i < at_.size(); ++i) all_.push_back(i);
    mesh_.emplace(surface.rest, corners_);
  }
  bool meets(const State& state, double radius) {
    surface_.points->points().place(surface_.points->curves().pairs(system_, state, *work_), all_, at_);
    mesh_->refit(at_);
    const Vec3 centre = system_.bodies(state).at(0).position;
    return mesh_->relation(exact::ball(centre, radius)).relation != exact::Relation::free;
  }

 private:
  const ContactSurface& surface_;
  const System& system_;
  System::WorkspacePtr work_;
  std::vector<Vec3> at_;
  std::vector<std::uint32_t> corners_, all_;
  std::optional<exact::Surface> mesh_;
};

/// At every accepted step in contact: out of contact the gap is the range and more.
TEST(SurfaceContact, ABallFallsOnALeafAndMeetsNoTriangle) {
  const Drop drop({.stiffness = 2e6, .range = 0.004});
  const System system(drop.scene);
  SimulationOptions options;
  options.tolerance = 1e-6;
  ExactLeaf leaf(drop.surface, system);
  Simulation simulation(system, system.rest_state(), options);
  long steps = 0, met = 0, in_contact = 0;
  double least = 1.0;
  simulation.on_progress([&](double) {
    const State& state = simulation.state();
    const auto& memory = dynamic_cast<const SurfaceMemory&>(*state.memory.at(0));
    ++steps;
    if (memory.touches.empty()) return true;
    ++in_contact;
    for (const SurfaceTouch& touch : memory.touches) least = std::min(least, touch.gap);
    met += leaf.meets(state, drop.radius);
    return true;
  });
  const Report report = simulation.run(0.8);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const double off = report.last.total() - report.first.total() - report.work;
  std::cout << steps << " steps, " << in_contact << " in contact, evaluations " << report.evaluations
            << ", energy off by " << off / (drop.mass * drop.g * drop.height) << " of the drop, least gap "
            << least << "\n";
  EXPECT_EQ(met, 0);
  EXPECT_GT(in_contact, 10);
  EXPECT_GT(least, 0.0);
  EXPECT_LE(std::abs(off), 1e-5 * drop.mass * drop.g * drop.height);
}

/// With damping a leaf that a ball struck comes back to where it was, when the ball is away.
TEST(SurfaceContact, AStruckLeafComesBackToItsRest) {
  Drop drop({.stiffness = 2e6, .range = 0.004});
  drop.scene.rods[0].mass_damping = 8.0;
  drop.scene.forces.pop_back();  // its weight
  drop.scene.bodies[0].velocity = Vec3(0, 0, -std::sqrt(2 * drop.g * drop.height));
  const System system(drop.scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-7});
  const auto off = [&] {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < drop.surface.rest.size(); ++i) all.push_back(i);
    std::vector<Vec3> at(all.size());
    const auto work = system.make_workspace();
    drop.surface.points->points().place(
        drop.surface.points->curves().pairs(system, simulation.state(), *work), all, at);
    double most = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i) most = std::max(most, (at[i] - drop.surface.rest[i]).norm());
    return most;
  };
  Report report = simulation.run(0.2);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_GT(off(), 0.01);
  report = simulation.run(4.0);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  std::cout << "back within " << off() << ", " << report.evaluations << " evaluations\n";
  EXPECT_GT(system.bodies(simulation.state()).at(0).position.norm(), 1.5);
  EXPECT_LE(off(), 1e-6);
}

/// What was on one side and is on the other has come through, however fast.
TEST(SurfaceContact, RefusesAJumpThrough) {
  Random random(4);
  const std::vector<Rod> rods = stalks();
  const SurfaceContact contact =
      contact_on(rods, {{"ball", ball(0.02), {}, {}, {}, 0}}, law_of(Law::Kind::barrier, kRange, 0.0, 0.0));
  int through = 0, beside = 0;
  for (int round = 0; round < 200; ++round) {
    Shown s = shown_of(rods, random, 0.002, 0.0);
    const Vec3 above(random.uniform(0.1, 0.9), random.uniform(-0.05, 0.05), random.uniform(0.1, 5.0));
    s.bodies = {{above, Mat3::Identity(), Vec3::Zero(), Vec3::Zero(), 1.0}};
    s.memory = contact.remember(s.view(), nullptr);
    const bool passes = round % 2 == 0;
    s.bodies[0].position = passes ? Vec3(above.x(), above.y(), -above.z())
                                  : Vec3(above.x(), above.y() + 10.0 * above.z(), above.z());
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    std::vector<Wrench> wrench(1);
    std::size_t refused = Loads::kNone;
    contact.add(s.view(), {force, torque, &refused, wrench});
    (passes ? through : beside) += refused != Loads::kNone;
  }
  EXPECT_EQ(through, 100);
  EXPECT_EQ(beside, 0);
}

/// Shot at a leaf that hangs free, at 1 to 1000 of its thicknesses a step.
TEST(SurfaceContact, LetsNothingThrough) {
  Random random(6);
  const Rod rod = test::straight_rod(8, 1e8, 0.012, 400.0);
  const ContactSurface surface = test::surface_on({rod}, test::leaf(1.0, 0.15, 20, 4), 0.004);
  const double radius = 0.03, mass = 1e-3;
  for (const double speed : {0.1, 1.0, 10.0, 100.0})
    for (int shot = 0; shot < 3; ++shot) {
      SCOPED_TRACE(speed);
      Scene scene;
      scene.rods = {rod};
      Body shell;
      shell.mass = mass;
      shell.inertia = 0.4 * mass * radius * radius * Mat3::Identity();
      // Beside the midrib it turns the leaf away and goes by.
      shell.position = Vec3(random.uniform(0.3, 0.7), shot == 0 ? 0.0 : random.uniform(-0.08, 0.08), 0.2);
      shell.velocity = Vec3(0, 0, -speed);
      scene.bodies = {shell};
      Collider collider{"ball", contact::ball(radius), {}};
      collider.body = 0;
      const Law law{.stiffness = std::max(1e3, 2e7 * mass * speed * speed), .range = 0.01};
      scene.forces = {std::make_shared<SurfaceContact>(surface, std::vector<Collider>{collider}, law)};
      const System system(scene);
      Simulation simulation(system, system.rest_state(), {.tolerance = 1e-4});
      ExactLeaf leaf(surface, system);
      long met = 0;
      simulation.on_progress([&](double) {
        met += leaf.meets(simulation.state(), radius);
        return true;
      });
      const Report report = simulation.run(0.4 / speed);
      ASSERT_EQ(report.stop, Stop::finished) << report.reason;
      EXPECT_EQ(met, 0);
      if (shot == 0) EXPECT_GT(system.bodies(simulation.state()).at(0).velocity.z(), 0.0);
    }
}

TEST(SurfaceContact, RefusesWhatIsNoSurfaceAndWhatBeginsWithin) {
  const std::vector<Rod> rods = stalks();
  const auto place_of = [&](const std::function<void(ContactSurface&, Law&)>& spoil) {
    ContactSurface surface = test::surface_on(rods, test::leaf(1.0, 0.2, 10, 2), kSkin);
    Law law = law_of(Law::Kind::barrier, kRange, 0.0, 0.0);
    spoil(surface, law);
    try {
      const SurfaceContact contact(surface, solids(), law);
    } catch (const InvalidInput& error) {
      return error.place();
    }
    return std::string("accepted");
  };
  EXPECT_EQ(place_of([](auto&, auto&) {}), "accepted");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.skin = 0.0; }), "contact.surface.skin");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.skin = std::nan(""); }), "contact.surface.skin");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.triangles[3][1] = 9999; }), "contact.surface.triangles[3]");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.triangles.clear(); }), "contact.surface.triangles");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.rest.pop_back(); }), "contact.surface.rest");
  EXPECT_EQ(place_of([](auto& s, auto&) { s.points = nullptr; }), "contact.surface.points");
  EXPECT_EQ(place_of([](auto&, auto& l) { l.range = 1e-12; }), "contact.law.range");
  Random random(1);
  const Shown s = shown_of(rods, random, 0.0, 0.0);
  const SurfaceContact within = contact_on(rods, {{"pole", ball(0.05), {.position = Vec3(0.5, 0.0, 0.02)}}},
                                           law_of(Law::Kind::barrier, kRange, 0, 0));
  EXPECT_THROW(within.remember(s.view(), nullptr), InvalidInput);
}

}  // namespace
}  // namespace tendril::contact
