#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"

namespace tendril {
namespace {

/// Gravity by another name; its loads are never asked for.
struct Falling : Force {
  explicit Falling(const Vec3& a) : acceleration(a) {}
  void add(const StateView&, const Loads&) const override { throw std::logic_error("add() was called"); }
  Couplings couplings(std::span<const NodeRange>) const override { return Couplings::none(); }
  std::optional<Vec3> uniform_acceleration() const override { return acceleration; }
  Vec3 acceleration;
};

State fallen(std::vector<std::shared_ptr<const Force>> forces, Energies* last = nullptr) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e5, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces = std::move(forces);
  const System system(scene);
  Simulation simulation(system, system.rest_state());
  const Report report = simulation.run(0.1);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  if (last) *last = report.last;
  return simulation.state();
}

TEST(UniformAcceleration, IsGravityWhoeverSaysIt) {
  const Vec3 a(0.25, 0, -8), b(0.5, 1, -2);
  Energies own, gravity;
  const State state = fallen({std::make_shared<Falling>(a), std::make_shared<Falling>(b)}, &own);
  EXPECT_EQ(state.y, fallen({std::make_shared<Gravity>(a + b)}, &gravity).y);
  EXPECT_NE(state.y, fallen({std::make_shared<Gravity>(a)}).y);
  EXPECT_EQ(own.potential, gravity.potential);
  EXPECT_LT(own.potential, 0.0);
}

}  // namespace
}  // namespace tendril
