#include <gtest/gtest.h>

#include "support/equilibria.h"

namespace tendril {
namespace {

using test::balanced;

TEST(Column, LeavesTheUprightStateOnlyWhereItIsAskedForAStableOne) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(20, 1e-3));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(test::point_load(PointLoad::Kind::force, 20, Vec3(-3, 0, 0)));  // critical: pi^2 / 4
  const System system(scene);
  StaticsOptions options;
  options.seek = StaticsOptions::Seek::nearest;
  const Equilibrium upright = balanced(system, options);
  EXPECT_EQ(upright.stability.kind, Stability::Kind::unstable);
  EXPECT_EQ(upright.stability.unstable, 2);  // both ways across
  EXPECT_EQ(upright.left, 0);
  options.seek = StaticsOptions::Seek::stable;
  const Equilibrium bent = balanced(system, options);
  EXPECT_EQ(bent.left, 1);
  EXPECT_EQ(bent.stability.unstable, 0);
  const Vec3 tip = test::at(bent.state.y, 20);
  EXPECT_GT(std::hypot(tip.y(), tip.z()), 0.3);
  EXPECT_LT(bent.elastic + bent.potential, upright.elastic + upright.potential - 0.01);
  // Deterministic: the same again, to the bit.
  EXPECT_EQ(balanced(system, options).state.y, bent.state.y);
}

/// Of a wind next to none the gusts change within no way at all: their derivative is not to be had.
TEST(Statics, SayWhereDerivativesAreNotFinite) {
  Scene scene;
  scene.rods.push_back(test::unit_rod(20, 1e-3));
  scene.anchors.push_back({0, 2, true, true, {}});
  scene.forces.push_back(std::make_shared<Wind>(WindOptions{.mean = Vec3(1e-160, 0, 0), .gust = 0.5}));
  const System system(scene);
  const Equilibrium out = find_equilibrium(system, system.rest_state(), {});
  EXPECT_EQ(out.balance, Balance::not_evaluable);
  EXPECT_NE(out.reason.find("not finite"), std::string::npos) << out.reason;
}

/// A load that may change with time has the potential of one that cannot.
TEST(DeadLoad, HasItsPotentialWhateverItsSignal) {
  const Vec3 load(0.2, 0, -1.5);
  for (const Signal& signal : {Signal::constant(load.norm()), Signal::table({{0.0, load.norm()}})}) {
    Scene scene;
    scene.rods.push_back(test::unit_rod(20, 1e-3));
    scene.anchors.push_back({0, 0, true, true, {}});
    scene.forces.push_back(
        std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 20, load.normalized(), signal));
    const System system(scene);
    const Equilibrium bent = balanced(system);
    const Vec3 tip = test::at(bent.state.y, 20);
    EXPECT_GT(std::abs(tip.z()), 0.1);
    EXPECT_NEAR(bent.potential, -load.dot(tip), 1e-12 * load.norm());
  }
}

}  // namespace
}  // namespace tendril
