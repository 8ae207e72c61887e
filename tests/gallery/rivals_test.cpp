#include <gtest/gtest.h>
#include <tendril/dynamics/check_force.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include <array>
#include <cmath>

#include "rivals/flat_run.h"
#include "rivals/lattice.h"
#include "rivals/mesh_springs.h"
#include "rivals/spring_force.h"
#include "shapes/grid.h"

namespace tendril::gallery {
namespace {

const bind::PolygonMesh kSheet = hanging_sheet(7, 7, 0.6, 0.6);

std::vector<Vec3> stirred(std::vector<Vec3> p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto k = static_cast<double>(i);
    p[i] += 0.02 * Vec3(std::sin(3 * k), std::sin(5 * k + 1), std::sin(7 * k + 2));
  }
  return p;
}

SpringNet sheet() {
  SpringNet net = cloth_net(kSheet.points, 7, 7, 0.1, {50, 25, 1});
  for (std::uint32_t i = 0; i < 7; ++i) net.held.push_back(i);
  net.damping = 0.5;
  return net;
}

TEST(SpringNet, HasTheThesissCountOnItsCloth) {
  EXPECT_EQ(sheet().springs.size(), 144u);
  EXPECT_EQ(sheet().mass.size(), 49u);
}

TEST(SpringNet, ForcesAreMinusTheEnergysGradient) {
  SpringNet net = sheet();
  for (std::uint32_t i = 1; i < 48; ++i) net.angles.push_back(angle_at(kSheet.points, i, 0.3));
  std::vector<Vec3> p = stirred(net.rest), force(p.size(), Vec3::Zero());
  add_forces(net, p, force);
  for (std::size_t i = 0; i < p.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-6;
      const double at = p[i][axis];
      p[i][axis] = at + kStep;
      const double ahead = elastic_energy(net, p);
      p[i][axis] = at - kStep;
      const double behind = elastic_energy(net, p);
      p[i][axis] = at;
      EXPECT_NEAR(force[i][axis], (behind - ahead) / (2 * kStep), 1e-7) << i;
    }
}

TEST(SpringNet, LargestFrequencyOfTwoMasses) {
  SpringNet net{{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {2.0, 2.0}, {}};
  net.springs.push_back(spring_between(net.rest, 0, 1, 9.0));
  EXPECT_NEAR(largest_frequency(net, net.rest), 3.0, 1e-5);
}

TEST(SpringForce, IsWhatItSays) {
  const SpringNet net = sheet();
  const std::size_t n = net.mass.size();
  const std::vector<Vec3> p = stirred(net.rest), v(n, Vec3::Zero()), t(n, Vec3::UnitX()), m(n, Vec3::UnitY());
  const std::array<double, 49> none{};
  const std::vector<NodeRange> rods{{0, n}};
  const StateView state{.time = 0.0,
                        .p = p,
                        .v = v,
                        .t = t,
                        .spin = none,
                        .mass = net.mass,
                        .width = none,
                        .rods = rods,
                        .m = m,
                        .turn = v};
  const ForceCheck springs = check_force(SpringForce(net), state);
  EXPECT_TRUE(springs.undeclared.empty());
  EXPECT_LT(springs.derivatives, 1e-7);
  EXPECT_LT(springs.energy, 1e-7);
  EXPECT_TRUE(check_force(UniformPush([](double) { return Vec3(1, 2, 3); }), state).undeclared.empty());
}

/// The sheet in the library, as in the gallery: each row a rod without springs.
Scene library_sheet(const SpringNet& net) {
  Scene scene;
  for (std::ptrdiff_t row = 0; row < 7; ++row) {
    const std::vector<Vec3> p(net.rest.begin() + 7 * row, net.rest.begin() + 7 * (row + 1));
    scene.rods.push_back(
        make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {0, 0, 0, 0, 0, net.mass[0], 1.0}));
    scene.rods.back().mass_damping = net.damping;
  }
  for (std::size_t i = 0; i < 7; ++i)
    scene.anchors.push_back({.rod = 0, .node = i, .holds_position = true, .holds_frame = false});
  scene.forces.push_back(std::make_shared<SpringForce>(net));
  scene.forces.push_back(std::make_shared<UniformPush>(net.acceleration));
  return scene;
}

// The rival's own loop is no other method than the library's: the same motion, as many steps.
TEST(FlatRun, MovesAsTheLibraryDoes) {
  SpringNet net = sheet();
  net.acceleration = [](double t) { return Vec3(0, 3 * std::sin(4 * t), -9.81); };
  FlatRun flat(net, at_rest(net), {1e-8, 0.6, 1.0});
  const NetReport& report = flat.run(1.0);
  ASSERT_TRUE(report.finished);
  const System system(library_sheet(net));
  Simulation library(system, system.rest_state(), {.method = Method::cash_karp, .tolerance = 1e-8});
  const Report other = library.run(1.0);
  ASSERT_EQ(other.stop, Stop::finished) << other.reason;
  double apart = 0.0;
  for (std::size_t i = 0; i < 49; ++i)
    apart = std::max(
        apart, (flat.state().p[i] - library.state().y.segment<3>(3 * static_cast<Eigen::Index>(i))).norm());
  EXPECT_LT(apart, 1e-6);
  EXPECT_GT(flat.state().p[45].y(), 1e-3);  // it does move
  EXPECT_LT(static_cast<double>(report.accepted), 2.5 * static_cast<double>(other.accepted));
  EXPECT_GT(static_cast<double>(report.accepted), 0.4 * static_cast<double>(other.accepted));
}

// Undamped, a mass on a spring is a sine: the error falls with the tolerance, the step stays under the guard.
TEST(FlatRun, SwingsAsASine) {
  SpringNet net{{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {1.0, 1.0}, {}, {}, {0}};
  net.springs.push_back(spring_between(net.rest, 0, 1, 4.0));
  NetState start = at_rest(net);
  start.v[1] = Vec3(0.1, 0, 0);
  double before = 1.0;
  for (const double tolerance : {1e-6, 1e-9}) {
    FlatRun run(net, start, {tolerance, 1.0, 20.0});
    ASSERT_TRUE(run.run(20.0).finished);
    const double error = std::abs(run.state().p[1].x() - 1.0 - 0.05 * std::sin(40.0));
    EXPECT_LT(error, 30 * tolerance);
    EXPECT_LT(error, before);
    EXPECT_GT(run.run(20.0).accepted, 2 * 20 / 0.45);
    before = error;
  }
}

TEST(FlatRun, SaysWhereItCannotGoOn) {
  SpringNet net{{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {1.0, 1.0}, {}};
  net.acceleration = [](double t) { return Vec3(t < 0.5 ? 0.0 : std::nan(""), 0, 0); };
  FlatRun run(net, at_rest(net), {1e-6, 1.0, 1.0});
  const NetReport& report = run.run(1.0);
  EXPECT_FALSE(report.finished);
  EXPECT_FALSE(report.reason.empty());
}

TEST(Lattice, KeepsWhatItIsNotMovedFor) {
  const Lattice lattice({Vec3(0, -1, -1), Vec3(3, 1, 1)}, {3, 2, 1});
  EXPECT_EQ(lattice.rest().size(), 4u * 3 * 2);
  const Vec3 x(0.7, 0.2, -0.4);
  EXPECT_LT((lattice.map(lattice.rest(), x) - x).norm(), 1e-15);
  std::vector<Vec3> moved;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Vec3& p : lattice.rest()) moved.emplace_back(2 * turn * p + Vec3(1, 0, 0));
  EXPECT_LT((lattice.map(moved, x) - (2 * turn * x + Vec3(1, 0, 0))).norm(), 1e-14);
}

TEST(Lattice, HasTheThesissSpringsInACell) {
  const Lattice one({Vec3(0, 0, 0), Vec3(1, 1, 1)}, {1, 1, 1}),
      four({Vec3(0, 0, 0), Vec3(4, 1, 1)}, {4, 1, 1});
  EXPECT_EQ(one.net(1, 1).mass.size(), 8u);
  EXPECT_EQ(one.net(1, 1).springs.size(), 18u);
  EXPECT_EQ(four.net(1, 1).mass.size(), 20u);
  EXPECT_EQ(four.net(1, 1).springs.size(), 18u + 3 * 13);
  EXPECT_EQ(four.layer(four.index(3, 1, 0)), 3);
}

}  // namespace
}  // namespace tendril::gallery
