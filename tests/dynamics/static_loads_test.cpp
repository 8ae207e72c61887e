#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/statics.h>

#include "support/rods.h"
#include "support/springs.h"

/// How equilibria take the derivatives of loads: all ways are one tangent, and lead the same way.
namespace tendril {
namespace {

using test::FarSpring;
using Says = FarSpring::Says;

/// Of what a far spring couples, its ends where it is not slack: by differences, or with its derivatives.
struct LocalSpring : FarSpring {
  using FarSpring::FarSpring;
  Couplings couplings(std::span<const NodeRange> rods) const override {
    std::vector<std::size_t> nodes;
    for (const NodeRange& rod : rods)
      for (std::size_t i = 0; i < rod.count; ++i) nodes.push_back(rod.first + i);
    Couplings all = Couplings::among(nodes).at_states([this](const StateView&) {
      LocalCouplings local{{{a, b}}, {}};
      local.add = [this](const StateView& state, const Loads& loads) { add(state, loads); };
      return local;
    });
    return says == Says::exact ? std::move(all).with(FarSpring::couplings(rods).derivatives()) : all;
  }
};

/// A clamped rod with a child in its middle and one at its end that it does not feel, a slide at the first
/// child's tip.
Scene tree() {
  Scene scene;
  const Rod trunk = test::straight_rod(8, 1e8, 0.02);
  scene.rods = {trunk, trunk, trunk};
  for (Vec3& p : scene.rods[1].p) p = Vec3(0.5, p.x(), 0);
  for (Vec3& q : scene.rods[1].q) q = Vec3(0.5, q.x(), 0.1);
  for (Vec3& p : scene.rods[2].p) p = Vec3(1, 0, p.x());
  for (Vec3& q : scene.rods[2].q) q = Vec3(1.1, 0, q.x());
  scene.joints = {{0, 4, 1, true}, {0, 8, 2, false}};
  scene.anchors = {
      {.rod = 0, .node = 0},
      {.rod = 1, .node = 8, .holds_frame = false, .slide = Anchor::Slide::line, .slide_axis = Vec3(1, 1, 2)}};
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -1))};
  return scene;
}

TEST(StaticLoads, AreOneTangentHoweverTheirDerivativesAreHad) {
  // Roots of both children, the sliding tip, nodes within.
  const std::vector<std::array<std::size_t, 2>> ends{{9, 22}, {18, 6}, {17, 3}, {14, 24}, {0, 12}};
  const auto search = [&](auto&& make) {
    Scene scene = tree();
    for (const auto& [a, b] : ends) scene.forces.push_back(make(a, b));
    const System system(scene);
    return find_equilibrium(system, system.rest_state());
  };
  const Equilibrium exact = search(
      [](std::size_t a, std::size_t b) { return std::make_shared<FarSpring>(a, b, 20.0, 0.4, Says::exact); });
  ASSERT_EQ(exact.balance, Balance::converged) << exact.reason;
  const Equilibrium others[] = {search([](std::size_t a, std::size_t b) {
                                  return std::make_shared<FarSpring>(a, b, 20.0, 0.4, Says::differences);
                                }),
                                search([](std::size_t a, std::size_t b) {
                                  return std::make_shared<LocalSpring>(a, b, 20.0, 0.4, Says::differences);
                                }),
                                search([](std::size_t a, std::size_t b) {
                                  return std::make_shared<LocalSpring>(a, b, 20.0, 0.4, Says::exact);
                                })};
  for (const Equilibrium& other : others) {
    ASSERT_EQ(other.balance, Balance::converged) << other.reason;
    EXPECT_EQ(other.iterations, exact.iterations);
    EXPECT_EQ(other.stability.kind, exact.stability.kind);
    EXPECT_LE((other.state.y - exact.state.y).cwiseAbs().maxCoeff(), 1e-8);
  }
}

/// Each node of a ladder's rails is tied to its opposite: in the order of the rods the factors would fill.
TEST(StaticLoads, AreEliminatedWithoutMuchFill) {
  const int edges = 150;
  Scene scene;
  scene.rods = {test::straight_rod(edges, 1e6, 0.02), test::straight_rod(edges, 1e6, 0.02)};
  for (Vec3& p : scene.rods[1].p) p.y() += 0.5;
  for (Vec3& q : scene.rods[1].q) q.y() += 0.5;
  scene.anchors = {{.rod = 0, .node = 0}, {.rod = 1, .node = 0}};
  scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -1))};
  for (std::size_t i = 1; i <= static_cast<std::size_t>(edges); ++i)
    scene.forces.push_back(std::make_shared<LocalSpring>(i, i + edges + 1, 50.0, 0.5, Says::exact));
  const System system(scene);
  const Equilibrium found = find_equilibrium(system, system.rest_state());
  ASSERT_EQ(found.balance, Balance::converged) << found.reason;
  EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
  // The rungs bear nothing: each rail sags as it does alone.
  scene.forces.resize(1);
  scene.rods.resize(1);
  scene.anchors.resize(1);
  const System alone(scene);
  const Equilibrium sagged = find_equilibrium(alone, alone.rest_state());
  const auto tip = static_cast<std::size_t>(edges);
  EXPECT_NEAR(test::at(found.state.y, tip).z(), test::at(sagged.state.y, tip).z(), 1e-9);
  EXPECT_NEAR(test::at(found.state.y, 2 * tip + 1).z(), test::at(sagged.state.y, tip).z(), 1e-9);
}

}  // namespace
}  // namespace tendril
