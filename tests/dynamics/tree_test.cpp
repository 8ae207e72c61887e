#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/simulation.h>

#include "support/rods.h"

namespace tendril {
namespace {

using test::Random;

/// A curved stem with a twig at an inner node, a leaf at the twig's second node, another leaf at the stem's
/// tip, and one at the root of the twig itself.
Scene tree(bool reaction = true) {
  Random random(12);
  Scene scene;
  const auto grow = [&](const Vec3& from, const Vec3& along, int nodes, double spacing) {
    std::vector<Vec3> p;
    for (int i = 0; i < nodes; ++i)
      p.push_back(from + spacing * i * along + 0.1 * spacing * i * i * Vec3(0.1, 0.2, 0.05));
    Rod rod = make_rod(p, orientation_towards(p, Vec3(0.3, 1, 0.2).cross(along), 0.1), {3e4, 1e4, 1000},
                       elliptic_section(0.05, 0.03));
    for (double& inertia : rod.inertia) inertia *= 20;
    scene.rods.push_back(rod);
  };
  grow(Vec3(0, 0, 0), Vec3::UnitZ(), 6, 0.2);
  grow(scene.rods[0].p[2], Vec3(1, 0.2, 0.4).normalized(), 4, 0.15);
  grow(scene.rods[1].p[1], Vec3(0.2, 1, 0.4).normalized(), 3, 0.12);
  grow(scene.rods[0].p[5], Vec3(-1, 0.3, 0.5).normalized(), 4, 0.12);
  grow(scene.rods[1].p[0], Vec3(0, -1, 0.1).normalized(), 3, 0.12);
  scene.joints = {{0, 2, 1, reaction}, {1, 1, 2, reaction}, {0, 5, 3, reaction}, {1, 0, 4, reaction}};
  return scene;
}

State thrown(const System& system) {
  State state = system.rest_state();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 p = state.y.segment<3>(3 * i);
    state.y.segment<3>(3 * n + 3 * i) = Vec3(0.3, -0.2, 0.5) + Vec3(0.8, 1.5, -1.0).cross(p);
    state.y[7 * n + i] = 3.0 + std::sin(static_cast<double>(i));
  }
  const auto work = system.make_workspace();
  if (!system.rebase(state, *work).ok()) throw std::runtime_error("cannot be thrown");
  return state;
}

TEST(Tree, GradientMatchesDifferences) {
  const System system(tree());
  Random random(3);
  const State state = test::stirred(system, random, 0.02);
  const auto work = system.make_workspace();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  double energy = 0.0;
  Eigen::VectorXd g;
  Eigen::VectorXd unused;
  ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, g, *work).ok());
  const double h = 1e-6;
  for (Eigen::Index k = 0; k < g.size(); ++k) {
    const Eigen::Index place = k < 3 * n ? k : 3 * n + k;
    double side[2];
    for (int s = 0; s < 2; ++s) {
      Eigen::VectorXd y = state.y;
      y[place] += s == 0 ? h : -h;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, y, side[s], unused, *work).ok());
    }
    EXPECT_NEAR((side[0] - side[1]) / (2 * h), g[k], 1e-7 * g.cwiseAbs().maxCoeff()) << k;
  }
}

TEST(Tree, KeepsEnergyAndBothMomentaAcrossJoints) {
  const System system(tree());
  State state = thrown(system);
  const auto work = system.make_workspace();
  const test::Momentum before = test::momentum(system, state);
  const double energy = system.energies(state, *work).total();
  CashKarp stepper(system);
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(stepper.advance(state, 5e-4).ok());
  const test::Momentum after = test::momentum(system, state);
  const double drift = std::abs(system.energies(state, *work).total() / energy - 1);
  const double linear = (after.linear - before.linear).norm() / before.linear.norm();
  const double angular = (after.angular - before.angular).norm() / before.angular.norm();
  std::printf("free tree, 1 s: energy %.2e, linear momentum %.2e, angular momentum %.2e\n", drift, linear,
              angular);
  EXPECT_LT(drift, 1e-8);
  EXPECT_LT(linear, 1e-13);
  EXPECT_LT(angular, 1e-9);
}

/// Falls by implicit steps so long that the rounding of the springs' blocks outweighs the masses.
TEST(Tree, KeepsItsWayInLongImplicitSteps) {
  Scene scene = tree();
  for (Rod& rod : scene.rods)
    for (auto* springs : {&rod.stretch, &rod.bend_l, &rod.bend_m, &rod.bend_t, &rod.twist})
      for (double& k : *springs) k *= 1e4;
  const Vec3 gravity(0.1, -0.2, -0.3), velocity(0.3, -0.2, 0.5);
  scene.forces.push_back(std::make_shared<Gravity>(gravity));
  const System system(scene);
  State state = system.rest_state();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 0; i < n; ++i) state.y.segment<3>(3 * n + 3 * i) = velocity;
  const test::Momentum before = test::momentum(system, state);
  Rodas stepper(system);
  const double mass = before.linear.norm() / velocity.norm();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(stepper.advance(state, 1.0).ok());
  const Vec3 exact = before.linear + 20.0 * mass * gravity;
  const double off = (test::momentum(system, state).linear - exact).norm() / exact.norm();
  std::printf("free tree, 20 s in 20 implicit steps: momentum off by %.1e\n", off);
  EXPECT_LT(off, 1e-13);
}

TEST(Tree, ConvergesAtOrderFive) {
  const System system(tree());
  const auto positions = [&](int steps) {
    State state = thrown(system);
    CashKarp stepper(system);
    for (int i = 0; i < steps; ++i)
      if (!stepper.advance(state, 0.5 / steps).ok()) throw std::runtime_error("step failed");
    return Eigen::VectorXd(state.y.head(3 * static_cast<Eigen::Index>(system.node_count())));
  };
  const Eigen::VectorXd reference = positions(2000);
  const double coarse = (positions(160) - reference).norm();
  const double fine = (positions(240) - reference).norm();
  const double order = std::log(coarse / fine) / std::log(1.5);
  std::printf("free tree: errors %.2e %.2e, order %.2f\n", coarse, fine, order);
  EXPECT_NEAR(order, 5.0, 0.3);
}

TEST(Tree, RootsStayOnTheirParentsFrames) {
  const System system(tree());
  State state = thrown(system);
  CashKarp stepper(system);
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(stepper.advance(state, 5e-4).ok());
  const std::vector<Frame> rest = system.frames(system.rest_state(), stepper.workspace());
  const std::vector<Frame> now = system.frames(state, stepper.workspace());
  for (const Joint& joint : system.scene().joints) {
    const std::size_t parent = system.rods()[joint.parent].first + joint.node;
    const std::size_t root = system.rods()[joint.child].first;
    EXPECT_EQ(test::at(state.y, root), test::at(state.y, parent));
    for (const auto& [a, b] : {std::pair{now[root].x, rest[root].x}, std::pair{now[root].z, rest[root].z}}) {
      EXPECT_NEAR(a.dot(now[parent].x), b.dot(rest[parent].x), 1e-13);
      EXPECT_NEAR(a.dot(now[parent].y), b.dot(rest[parent].y), 1e-13);
      EXPECT_NEAR(a.dot(now[parent].z), b.dot(rest[parent].z), 1e-13);
    }
  }
  EXPECT_GT((now[0].z - rest[0].z).norm(), 0.1);
}

TEST(Tree, OneWayJointsLeaveTheParentAlone) {
  const auto stem_after = [](const Scene& scene) {
    const System system(scene);
    State state = thrown(system);
    CashKarp stepper(system);
    for (int i = 0; i < 400; ++i)
      if (!stepper.advance(state, 5e-4).ok()) throw std::runtime_error("step failed");
    return Eigen::VectorXd(state.y.head(18));
  };
  Scene alone = tree();
  alone.rods.resize(1);
  alone.joints.clear();
  alone.twist = Scene::Twist::everywhere;
  EXPECT_LT((stem_after(tree(false)) - stem_after(alone)).norm(), 1e-13);
  EXPECT_GT((stem_after(tree(true)) - stem_after(alone)).norm(), 1e-3);
}

TEST(Tree, BalancesEnergyWhenTheParentIsMovedByHand) {
  for (const bool reaction : {true, false}) {
    Scene scene = tree(reaction);
    Anchor hand;
    hand.motion = [at = node_frames(scene.rods[0].p, scene.rods[0].q).frame[0]](double t) {
      const double angle = 0.5 * std::sin(4 * t);
      AnchorPose pose;
      pose.frame = {rotate_about(Vec3::UnitY(), angle, at.x), rotate_about(Vec3::UnitY(), angle, at.y),
                    rotate_about(Vec3::UnitY(), angle, at.z)};
      pose.angular_velocity = 2.0 * std::cos(4 * t) * Vec3::UnitY();
      return pose;
    };
    scene.anchors.push_back(hand);
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0.2, 0, -1.0)));
    for (Rod& rod : scene.rods) rod.viscosity = 1e-3;
    const System system(scene);
    SimulationOptions options;
    options.tolerance = 1e-7;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(1.0);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    std::printf("tree in the hand, %s: imbalance %.1e\n", reaction ? "with reaction" : "one way",
                report.imbalance);
    EXPECT_LT(std::abs(report.imbalance), 1e-6);
  }
}

TEST(TreeInput, IsRefusedWithThePlace) {
  const auto place = [](const std::function<void(Scene&)>& spoil) -> std::string {
    Scene scene = tree();
    spoil(scene);
    return test::place_of_refusal(scene);
  };
  EXPECT_EQ(place([](Scene&) {}), "accepted");
  EXPECT_EQ(place([](Scene& s) { s.joints[1].parent = 9; }), "joints[1].parent");
  EXPECT_EQ(place([](Scene& s) { s.joints[0].child = 9; }), "joints[0].child");
  EXPECT_EQ(place([](Scene& s) { s.joints[0].node = 6; }), "joints[0].node");
  EXPECT_EQ(place([](Scene& s) { s.joints[0].node = 3; }), "joints[0].node");
  EXPECT_EQ(place([](Scene& s) { s.joints[3].child = 1; }), "joints[3].child");
  EXPECT_EQ(place([](Scene& s) { s.anchors.push_back({1, 0, true, true, {}}); }), "joints[0].child");
  EXPECT_EQ(place([](Scene& s) {
              // A ring: the stem rides on the leaf at the root of its twig.
              s.joints = {{0, 0, 1, true}, {1, 0, 0, true}};
              s.rods.resize(2);
              for (Vec3* p : {&s.rods[1].p[0]}) *p = s.rods[0].p[0];
            }),
            "joints");
}

}  // namespace
}  // namespace tendril
