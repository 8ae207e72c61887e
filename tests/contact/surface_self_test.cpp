#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/contact/surface_self_contact.h>
#include <tendril/curve/frames.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/exact/surface.h>

#include "bush.h"
#include "laws.h"
#include "shown.h"

namespace tendril::contact {
namespace {

using test::Random;
using test::Sheets;
using test::Shown;
using test::shown_of;

constexpr double kSelfSkin = 0.01, kSelfRange = 0.03;

const SurfaceSelfMemory& memory_of(const Shown& s) {
  return static_cast<const SurfaceSelfMemory&>(*s.memory);
}

TEST(SurfaceSelf, KeepsToWhatItSaysOfItself) {
  Random random(1);
  // Edges of leaves turned by 0.01 are all but parallel to their likes.
  for (const double angle : {1.3, 0.01})
    for (const Law::Kind kind : {Law::Kind::barrier, Law::Kind::penalty}) {
      SCOPED_TRACE(kind == Law::Kind::barrier ? "barrier" : "penalty");
      const Sheets sheets = test::crossed(2 * kSelfSkin + 0.015, angle);
      const SurfaceSelfContact contact(sheets.surface(kSelfSkin), law_of(kind, kSelfRange, 0.0, 0.0));
      Shown s = shown_of(sheets.rods, random, 0.002, 0.5);
      s.memory = contact.remember(s.view(), nullptr);
      ASSERT_GT(memory_of(s).touches.size(), 30u);
      for (Vec3& p : s.p) p += random.in_cube(1e-5);
      const ForceCheck check = check_force(contact, s.view(), 1e-6);
      EXPECT_TRUE(check.undeclared.empty());
      EXPECT_LT(check.local, 1e-12);
      ASSERT_TRUE(contact.has_energy());
      EXPECT_LT(check.energy, 2e-6);
    }
}

/// What it says of a state, that implicit steps differentiate, with friction and damping, and after steps in
/// which it slid.
TEST(SurfaceSelf, SaysWhatActsAtAState) {
  Random random(6);
  const Sheets sheets = test::crossed(2 * kSelfSkin + 0.012);
  const SurfaceSelfContact contact(sheets.surface(kSelfSkin),
                                   law_of(Law::Kind::barrier, kSelfRange, 0.3, 0.2));
  Shown s = shown_of(sheets.rods, random, 0.002, 0.5);
  s.memory = contact.remember(s.view(), nullptr);
  for (int step = 0; step < 3; ++step) {
    for (Vec3& p : s.p) p += random.in_cube(1e-4);
    s.memory = contact.remember(s.view(), s.memory);
  }
  const ForceCheck check = check_force(contact, s.view(), 1e-7);
  EXPECT_TRUE(check.undeclared.empty());
  EXPECT_LT(check.local, 1e-12);
}

/// What comes of inner forces alone: no force, and no torque but for friction.
TEST(SurfaceSelf, PushesNothingFromOutside) {
  Random random(2);
  const Sheets sheets = test::crossed(2 * kSelfSkin + 0.012);
  for (const double friction : {0.0, 0.4}) {
    SCOPED_TRACE(friction);
    const SurfaceSelfContact contact(sheets.surface(kSelfSkin),
                                     law_of(Law::Kind::barrier, kSelfRange, friction, friction));
    Shown s = shown_of(sheets.rods, random, 0.002, 0.5);
    s.memory = contact.remember(s.view(), nullptr);
    for (Vec3& p : s.p) p += random.in_cube(1e-4);
    s.memory = contact.remember(s.view(), s.memory);
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    contact.add(s.view(), {force, torque});
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double scale = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      sum += force[i];
      moment += s.p[i].cross(force[i]) + torque[i];
      scale += force[i].norm();
    }
    ASSERT_GT(scale, 0.0);
    EXPECT_LT(sum.norm(), 1e-12 * scale);
    if (friction == 0.0) EXPECT_LT(moment.norm(), 1e-12 * scale);
  }
}

/// Two flat sheets one above the other hold about the potential of their gap times their area, whether edges
/// are longer or shorter than the range.
TEST(SurfaceSelf, WeighsAreas) {
  Random random(4);
  const test::Leaf wide = test::leaf(1.0, 0.5, 24, 12), small = test::leaf(0.5, 0.2, 15, 5);
  double area = 0.0;
  for (const auto& [a, b, c] : small.triangles)
    area += 0.5 * (small.points[b] - small.points[a]).cross(small.points[c] - small.points[a]).norm();
  for (const double range : {0.01, 0.03, 0.06})
    for (const double turned : {0.0, 0.3, 1.0}) {
      const double skin = 0.1 * range, gap = 0.3 * range;
      const Law law = law_of(Law::Kind::barrier, range, 0.0, 0.0);
      const Vec3 at(0.3, -0.1, 2 * skin + gap);
      Sheets sheets;
      const Rod rod = test::straight_rod(8, 1e6, 0.01, 400.0);
      sheets.add(wide, rod, Vec3::Zero());
      sheets.add(small, rod, at, test::about_z(turned));
      for (Vec3& p : sheets.rods[1].p) p = at + 0.5 * (p - at);
      for (Vec3& q : sheets.rods[1].q) q = at + 0.5 * (q - at);
      const SurfaceSelfContact contact(sheets.surface(skin), law);
      const Shown s = shown_of(sheets.rods, random, 0.0, 0.0);
      const double ratio = contact.energy(s.view()) / (area * law.stiffness * potential(law, gap).value);
      std::cout << "range " << range << ", turned " << turned << ": " << ratio << " of the area's\n";
      EXPECT_GT(ratio, 0.8);
      EXPECT_LT(ratio, 1.2);
    }
}

/// Holds the parts of a mesh against each other at accepted states, exactly.
class ExactParts {
 public:
  ExactParts(const ContactSurface& surface, const System& system, std::size_t first_of_second)
      : surface_(surface), system_(system), work_(system.make_workspace()), at_(surface.rest.size()) {
    std::vector<std::uint32_t> corners;
    for (const auto& t : surface.triangles) {
      if (t[0] >= first_of_second)
        others_.push_back(t);
      else
        corners.insert(corners.end(), t.begin(), t.end());
    }
    for (std::uint32_t i = 0; i < at_.size(); ++i) all_.push_back(i);
    first_ = first_of_second;
    mesh_.emplace(Points(surface.rest).first(first_), corners);
  }
  long meets(const State& state) {
    surface_.points->points().place(surface_.points->curves().pairs(system_, state, *work_), all_, at_);
    mesh_->refit(Points(at_).first(first_));
    long met = 0;
    for (const auto& [a, b, c] : others_)
      met += mesh_->relation(exact::triangle({at_[a], at_[b], at_[c]})).relation != exact::Relation::free;
    return met;
  }

 private:
  const ContactSurface& surface_;
  const System& system_;
  System::WorkspacePtr work_;
  std::vector<Vec3> at_;
  std::vector<std::uint32_t> all_;
  std::vector<std::array<std::uint32_t, 3>> others_;
  std::size_t first_ = 0;
  std::optional<exact::Surface> mesh_;
};

/// One leaf lies free above another, which is clamped at its foot, and falls on it.
TEST(SurfaceSelf, ALeafFallsOnALeafAndMeetsNoTriangle) {
  Sheets sheets;
  const Rod rod = test::straight_rod(8, 1e8, 0.012, 400.0);
  const test::Leaf leaf = test::leaf(1.0, 0.15, 20, 4);
  const double height = 0.1, skin = 0.004;
  sheets.add(leaf, rod, Vec3::Zero());
  sheets.add(leaf, rod, Vec3(0.5, -0.45, height + 2 * skin), test::about_z(1.2));
  const ContactSurface surface = sheets.surface(skin);
  Scene scene;
  scene.rods = sheets.rods;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = {std::make_shared<SurfaceSelfContact>(surface, Law{.stiffness = 2e6, .range = 0.004}),
                  std::make_shared<Gravity>(Vec3(0, 0, -9.81))};
  const System system(scene);
  SimulationOptions options;
  options.tolerance = 1e-6;
  ExactParts parts(surface, system, leaf.points.size());
  Simulation simulation(system, system.rest_state(), options);
  long met = 0, in_contact = 0;
  double least = 1.0;
  simulation.on_progress([&](double) {
    const auto& memory = dynamic_cast<const SurfaceSelfMemory&>(*simulation.state().memory.at(0));
    if (memory.touches.empty()) return true;
    ++in_contact;
    for (const SelfTouch& touch : memory.touches) least = std::min(least, touch.gap);
    met += parts.meets(simulation.state());
    return true;
  });
  const Report report = simulation.run(0.25);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  double mass = 0.0;
  for (const double m : rod.mass) mass += m;
  const double off = report.last.total() - report.first.total() - report.work;
  const auto& memory = dynamic_cast<const SurfaceSelfMemory&>(*simulation.state().memory.at(0));
  std::cout << in_contact << " steps in contact, evaluations " << report.evaluations << ", energy off by "
            << off / (mass * 9.81 * height) << " of the drop, least gap " << least << ", searches "
            << memory.searches << ", contacts " << memory.begun << "\n";
  EXPECT_EQ(met, 0);
  EXPECT_GT(in_contact, 10);
  EXPECT_GT(least, 0.0);
  EXPECT_LE(std::abs(off), 1e-4 * mass * 9.81 * height);
}

/// A strip with its second half over its first, a diameter above.
Shown folded(const Rod& rod, double diameter) {
  Shown s;
  const double turn = 0.5 * M_PI * diameter, leg = 0.5 * (1.0 - turn);
  const auto count = rod.p.size();
  std::vector<Vec3> q;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i) / static_cast<double>(count - 1);
    const double angle = std::clamp((at - leg) / turn, 0.0, 1.0) * M_PI;
    const double back = std::max(0.0, at - leg - turn);
    const Vec3 outward(std::sin(angle), 0, -std::cos(angle));
    s.p.push_back(Vec3(std::min(at, leg) - back, 0, 0.5 * diameter) + 0.5 * diameter * outward);
    q.push_back(s.p.back() - 0.1 * outward);
  }
  s.rods = {{0, count}};
  const NodeFrames frames = node_frames(s.p, q);
  for (const Frame& frame : frames.frame) {
    s.v.emplace_back(Vec3::Zero()), s.turn.emplace_back(Vec3::Zero());
    s.t.push_back(frame.z), s.m.push_back(frame.y);
    s.spin.push_back(0.0), s.mass.push_back(1.0), s.width.push_back(0.1);
  }
  return s;
}

/// As stiff pieces patches of one part are passed over; these are not.
TEST(SurfaceSelf, FeelsAFold) {
  Sheets sheets;
  const Rod rod = test::straight_rod(32, 1e6, 0.01, 400.0);
  sheets.add(test::leaf(1.0, 0.06, 10, 1), rod, Vec3::Zero());
  const double skin = 0.02;
  const SurfaceSelfContact contact(sheets.surface(skin), law_of(Law::Kind::barrier, 0.025, 0.0, 0.0));
  EXPECT_GT(contact.energy(folded(rod, 0.055).view()), 0.0);
  EXPECT_EQ(contact.energy(folded(rod, 0.12).view()), 0.0);
}

/// What was on one side and is on the other has come through, however fast.
TEST(SurfaceSelf, RefusesAJumpThrough) {
  Random random(5);
  const Sheets sheets = test::crossed(2 * kSelfSkin + 0.05);
  const SurfaceSelfContact contact(sheets.surface(kSelfSkin),
                                   law_of(Law::Kind::barrier, kSelfRange, 0.0, 0.0));
  int through = 0, beside = 0;
  for (int round = 0; round < 100; ++round) {
    Shown s = shown_of(sheets.rods, random, 0.002, 0.0);
    const double up = random.uniform(0.0, 3.0);
    for (std::size_t i = 9; i < 18; ++i) s.p[i].z() += up;
    s.memory = contact.remember(s.view(), nullptr);
    for (std::size_t i = 9; i < 18; ++i) {
      if (round % 2 == 0)
        s.p[i].z() -= 2.0 * up + 0.2;
      else
        s.p[i].x() += 10.0 * up + 0.1;
    }
    std::vector<Vec3> force(s.p.size(), Vec3::Zero()), torque = force;
    std::size_t refused = Loads::kNone;
    contact.add(s.view(), {force, torque, &refused});
    (round % 2 == 0 ? through : beside) += refused != Loads::kNone;
  }
  EXPECT_EQ(through, 50);
  EXPECT_EQ(beside, 0);
}

/// A strip whose ends are thrown at each other, free in the air.
TEST(SurfaceSelf, AFoldDoesNotPassThroughItself) {
  const Rod rod = test::straight_rod(12, 2e5, 0.02, 400.0);
  Sheets sheets;
  sheets.add(test::leaf(1.0, 0.1, 24, 2), rod, Vec3::Zero());
  const double skin = 0.01;
  const ContactSurface surface = sheets.surface(skin);
  Scene scene;
  scene.rods = sheets.rods;
  scene.forces = {std::make_shared<SurfaceSelfContact>(surface, Law{.stiffness = 3e7, .range = 0.01})};
  const System system(scene);
  State state = system.rest_state();
  for (int i = 0; i <= 12; ++i) {
    const double s = i / 12.0 - 0.5;
    state.y.segment<3>(3 * 13 + 3 * i) = Vec3(-30.0 * s * std::abs(s), 4.0 * s, 12.0 * std::abs(s));
  }
  Simulation simulation(system, state, {.tolerance = 1e-5});
  double least = 1.0;
  long in_contact = 0;
  simulation.on_progress([&](double) {
    const auto& memory = dynamic_cast<const SurfaceSelfMemory&>(*simulation.state().memory.at(0));
    for (const SelfTouch& touch : memory.touches) least = std::min(least, touch.gap);
    in_contact += !memory.touches.empty();
    return true;
  });
  const Report report = simulation.run(0.3);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const auto& memory = dynamic_cast<const SurfaceSelfMemory&>(*simulation.state().memory.at(0));
  std::cout << in_contact << " steps in contact, least gap " << least << ", evaluations "
            << report.evaluations << ", searches " << memory.searches << ", looked at " << memory.looked_at
            << "\n";
  EXPECT_GT(in_contact, 10);
  EXPECT_GT(least, 0.0);
}

/// Leaves of a plant on a stem, in wind; none comes through another, exactly, at any accepted step.
TEST(SurfaceSelf, LeavesInWindDoNotPassThroughEachOther) {
  Random random(7);
  const test::Bush bush(random, 12, 13, 3, 0.009);
  const ContactSurface surface = bush.sheets.surface(4e-4);
  for (const Meets which : {Meets::all, Meets::other_parts}) {
    Scene scene;
    scene.rods = bush.sheets.rods;
    for (std::size_t r = 0; r < scene.rods.size(); ++r) scene.anchors.push_back({.rod = r, .node = 0});
    const Law law{.stiffness = 2e7, .range = 8e-4, .damping = 0.02};
    WindOptions wind;
    wind.mean = Vec3(5, 0, 0);
    scene.forces = {std::make_shared<SurfaceSelfContact>(surface, law, which), std::make_shared<Wind>(wind),
                    std::make_shared<Gravity>(Vec3(0, 0, -9.81))};
    const System system(scene);
    Simulation simulation(system, system.rest_state(), {.method = Method::cash_karp, .tolerance = 1e-3});
    const auto work = system.make_workspace();
    std::vector<std::uint32_t> all(surface.rest.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<Vec3> at(all.size());
    long met = 0, in_contact = 0, steps = 0;
    simulation.on_progress([&](double) {
      const State& state = simulation.state();
      in_contact += !dynamic_cast<const SurfaceSelfMemory&>(*state.memory.at(0)).touches.empty();
      if (++steps % 20 != 0) return true;
      surface.points->points().place(surface.points->curves().pairs(system, state, *work), all, at);
      met += test::meeting_pairs(bush, at);
      return true;
    });
    const Report report = simulation.run(0.17);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    std::cout << steps << " steps, " << in_contact << " in contact\n";
    EXPECT_EQ(met, 0);
    EXPECT_GT(in_contact, 20);
  }
}

TEST(SurfaceSelf, RefusesWhatBeginsInContactAndWhatIsNoSurface) {
  Random random(6);
  const Sheets sheets = test::crossed(2 * kSelfSkin - 0.001);
  const Shown s = shown_of(sheets.rods, random, 0.0, 0.0);
  const SurfaceSelfContact within(sheets.surface(kSelfSkin), law_of(Law::Kind::barrier, kSelfRange, 0, 0));
  EXPECT_THROW(within.remember(s.view(), nullptr), InvalidInput);
  ContactSurface spoilt = sheets.surface(kSelfSkin);
  spoilt.triangles[2][0] = 99999;
  EXPECT_THROW(SurfaceSelfContact(spoilt, law_of(Law::Kind::barrier, kSelfRange, 0, 0)), InvalidInput);
  EXPECT_THROW(SurfaceSelfContact(sheets.surface(kSelfSkin), law_of(Law::Kind::barrier, -1.0, 0, 0)),
               InvalidInput);
}

}  // namespace
}  // namespace tendril::contact
