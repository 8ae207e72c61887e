#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/statics.h>

#include "support/numbers.h"
#include "support/rods.h"

namespace tendril {
namespace {

using test::kGravity;

constexpr double kRelease = 0.2, kEnd = 0.7;

Scene hanging(bool anisotropic, double until) {
  Scene scene;
  const std::vector<Vec3> p = test::straight(10, 1.0);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3(0, 0.5, 1), 0.1), {1e6, 3e5, 1000},
                                elliptic_section(0.02, anisotropic ? 0.012 : 0.02)));
  scene.anchors.push_back({.rod = 0, .node = 0, .until = until});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kGravity)));
  return scene;
}

double mass_of(const Rod& rod) {
  double mass = 0.0;
  for (const double m : rod.mass) mass += m;
  return mass;
}

SimulationOptions options_for(Method method) {
  SimulationOptions options;
  options.method = method;
  options.tolerance = 1e-7;
  return options;
}

class Released : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, Released,
                         testing::Values(Method::cash_karp, Method::rodas, Method::nystrom),
                         [](const auto& method) { return std::string(to_string(method.param)); });

TEST_P(Released, RodFallsFreely) {
  for (const bool anisotropic : {false, true}) {
    const System system(hanging(anisotropic, kRelease));
    const System free(system.scene(), kRelease);
    Simulation simulation(system, system.rest_state(), options_for(GetParam()));
    ASSERT_EQ(simulation.run(kRelease).stop, Stop::finished);
    const State before = simulation.state();
    const Report report = simulation.run(kEnd);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_LT(std::abs(report.imbalance), 1e-5);

    const test::Momentum at_release = test::momentum(free, before);
    const test::Momentum at_end = test::momentum(free, simulation.state());
    const double mass = mass_of(system.scene().rods[0]), fallen = kEnd - kRelease;
    const Vec3 fall(0, 0, -mass * kGravity * fallen);
    EXPECT_LT((at_end.linear - at_release.linear - fall).norm(), 1e-9 * fall.norm());
    // About the origin: the weight acts at the center of mass, which flies on a parabola.
    Vec3 center = Vec3::Zero();
    for (std::size_t i = 0; i < system.node_count(); ++i)
      center += system.scene().rods[0].mass[i] / mass * test::at(before.y, i);
    const Vec3 speed = at_release.linear / mass;
    const Vec3 turned =
        (center * fallen + speed * (0.5 * fallen * fallen)).cross(Vec3(0, 0, -mass * kGravity));
    EXPECT_LT((at_end.angular - at_release.angular - turned).norm(), 1e-6 * turned.norm());
  }
}

TEST(ReleasedAnchor, IsTheSameAsASceneWithoutItFromThere) {
  const System system(hanging(true, kRelease));
  Simulation simulation(system, system.rest_state(), options_for(Method::cash_karp));
  simulation.run(kEnd);
  const System held(hanging(true, HUGE_VAL));
  Simulation first(held, held.rest_state(), options_for(Method::cash_karp));
  first.run(kRelease);
  Scene scene = held.scene();
  scene.anchors.clear();
  const System free(scene);
  State state = first.state();
  ASSERT_TRUE(free.rebase(state, *free.make_workspace()).ok());
  Simulation second(free, state, options_for(Method::cash_karp));
  second.run(kEnd);
  const auto n = 3 * static_cast<Eigen::Index>(system.node_count());
  EXPECT_LT((simulation.state().y.head(n) - second.state().y.head(n)).norm(), 1e-5);
  EXPECT_GT((simulation.state().y.head(n) - first.state().y.head(n)).norm(), 0.1);
}

TEST(ReleasedAnchor, LetsATurningClampsSpinGoOn) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e6, 0.02));
  Anchor anchor{.rod = 0, .node = 0, .until = 0.5};
  anchor.motion = [](double t) {
    AnchorPose pose;
    pose.frame = {rotate_about(Vec3::UnitX(), 8 * t, -Vec3::UnitY()),
                  rotate_about(Vec3::UnitX(), 8 * t, Vec3::UnitZ()), Vec3::UnitX()};
    pose.angular_velocity = Vec3(8, 0, 0);
    return pose;
  };
  scene.anchors.push_back(anchor);
  const System system(scene);
  const System free(scene, 0.5);
  Simulation simulation(system, system.rest_state(), options_for(Method::cash_karp));
  ASSERT_EQ(simulation.run(0.5).stop, Stop::finished);
  const double before = test::momentum(free, simulation.state()).angular.x();
  ASSERT_EQ(simulation.run(1.0).stop, Stop::finished);
  EXPECT_GT(before, 0.0);
  EXPECT_NEAR(test::momentum(free, simulation.state()).angular.x(), before, 1e-6 * before);
}

TEST(ReleasedAnchor, RestartsTheChoiceAndKeepsTheBook) {
  SimulationOptions options = options_for(Method::automatic);
  options.tolerance = 1e-3;
  const System system(hanging(false, kRelease));
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(kEnd);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  ASSERT_GE(report.switches.size(), 2u);
  EXPECT_TRUE(std::any_of(report.switches.begin(), report.switches.end(),
                          [](const Switch& entry) { return entry.time == kRelease; }));
  EXPECT_EQ(report.time, kEnd);
  EXPECT_NEAR(report.first.total(), 0.0, 1e-12);
}

TEST(ReleasedAnchor, IsGoneWhenTheRunBeginsLater) {
  const System system(hanging(false, kRelease));
  Simulation simulation(system, system.rest_state(0.3), options_for(Method::cash_karp));
  ASSERT_EQ(simulation.run(0.5).stop, Stop::finished);
  EXPECT_NEAR(simulation.state().y[2], -0.5 * kGravity * 0.04, 1e-6);
}

TEST(ReleasedAnchor, IsGoneForStaticsOfTheSystemFromThere) {
  Scene scene = hanging(false, HUGE_VAL);
  scene.anchors.push_back({.rod = 0, .node = 10, .until = kRelease});
  const System freed(scene, kRelease);
  scene.anchors.pop_back();
  scene.twist = Scene::Twist::everywhere;
  const System without(scene);
  const auto tip = [](const System& system) {
    const Equilibrium found = find_equilibrium(system, system.rest_state());
    EXPECT_EQ(found.balance, Balance::converged) << found.reason;
    return test::at(found.state.y, 10);
  };
  EXPECT_LT(tip(without).z(), -0.01);
  EXPECT_LT((tip(freed) - tip(without)).norm(), 1e-7);
}

TEST(ReleasedAnchor, ThatLeavesAFoldEndsTheRunWithItsReason) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(2, 1e3, 0.01));
  scene.anchors.push_back({.rod = 0, .node = 1, .until = 1e-9});
  // Springs at a held frame reach half a turn, so there are none.
  for (auto* springs : {&scene.rods[0].bend_l, &scene.rods[0].bend_m, &scene.rods[0].bend_t})
    (*springs)[1] = 0.0;
  const System system(scene);
  State folded = system.rest_state();
  folded.y.segment<3>(6) = folded.y.segment<3>(0);
  ASSERT_TRUE(system.rebase(folded, *system.make_workspace()).ok());
  Simulation simulation(system, folded, options_for(Method::cash_karp));
  const Report report = simulation.run(1.0);
  EXPECT_EQ(report.stop, Stop::not_evaluable);
  EXPECT_NE(report.reason.find("lets go"), std::string::npos) << report.reason;
  EXPECT_EQ(simulation.state().time, 1e-9);
  EXPECT_EQ(simulation.pairs().size(), 1U);
}

TEST(ReleasedAnchor, NeedsATime) {
  EXPECT_EQ(test::place_of_refusal(hanging(false, std::nan(""))), "anchors[0].until");
}

/// Stiff rods that shake a little until they are let go, and fly for long: what is wrong about their shaking
/// at the release, and about their turning after it, is carried as far as they fly.
struct ShakenAndReleased {
  int edges;
  double young, radius, damping, release, end;
};

Eigen::VectorXd end_of(const System& system, const SimulationOptions& options, double end) {
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(end);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  return simulation.state().y.head(3 * static_cast<Eigen::Index>(system.node_count()));
}

TEST(ReleasedRod, FliesWhereItsShakingSendsIt) {
  for (const ShakenAndReleased& s :
       {ShakenAndReleased{2, 2e8, 2e-2, 0.029, 2.5, 4.9}, ShakenAndReleased{2, 3e8, 3e-2, 0.0, 1.2, 3.2},
        ShakenAndReleased{6, 3e10, 2e-3, 0.1, 1.1, 6.0}}) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(s.edges, s.young, s.radius));
    scene.rods[0].mass_damping = s.damping;
    scene.anchors.push_back({.rod = 0, .node = 0, .until = s.release});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kGravity)));
    const System system(scene);
    const double w = system.largest_frequency(system.rest_state(), 16, *system.make_workspace());
    SimulationOptions fine;
    fine.method = Method::runge_kutta4;
    fine.fixed_step = 0.5 / w;
    fine.work_limit = 100'000'000;
    SimulationOptions told;
    told.tolerance = 1e-3;
    const Eigen::VectorXd right = end_of(system, fine, s.end);
    fine.fixed_step = 1.0 / w;
    const double unsure = (end_of(system, fine, s.end) - right).cwiseAbs().maxCoeff();
    EXPECT_LT(unsure, 0.5 * told.tolerance);
    EXPECT_LT((end_of(system, told, s.end) - right).cwiseAbs().maxCoeff(), 10 * told.tolerance)
        << s.edges << " edges, E " << s.young;
  }
}

}  // namespace
}  // namespace tendril
