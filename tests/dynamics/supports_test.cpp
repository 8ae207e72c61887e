#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/supports.h>

#include "support/equilibria.h"

namespace tendril {
namespace {

using test::balanced;
using test::Random;
using Kind = PointLoad::Kind;

constexpr double kWeight = 9.81;

/// By the balance of the whole rod: the sum of the loads' moments about the clamp, their own torques too.
Vec3 moment_of_weight(const Scene& scene, const State& state) {
  Vec3 sum = Vec3::Zero();
  const Vec3 from = test::at(state.y, scene.anchors[0].node);
  for (std::size_t i = 0; i < scene.rods[0].p.size(); ++i)
    sum += (test::at(state.y, i) - from).cross(scene.rods[0].mass[i] * Vec3(0, 0, -kWeight));
  return sum;
}

Scene stiff_cantilever(int edges, Scene::Twist twist = Scene::Twist::where_needed) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(edges, 1e10, 0.01));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.twist = twist;
  return scene;
}

TEST(Supports, CarryACantileversWeightAndItsMoment) {
  for (const auto twist : {Scene::Twist::where_needed, Scene::Twist::everywhere})
    for (const int edges : {1, 3, 16}) {
      Scene scene = stiff_cantilever(edges, twist);
      scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kWeight)));
      const Equilibrium found = balanced(System(scene));
      const double weight = kWeight * test::total_mass(scene.rods[0]);
      EXPECT_LT((found.support.at(0) - Vec3(0, 0, weight)).norm(), 1e-8 * weight);
      EXPECT_LT((found.torque.at(0) + moment_of_weight(scene, found.state)).norm(), 1e-8 * weight);
      // w L^2 / 2, held up against what turns z down towards x; it bends by 5e-3 of its length.
      EXPECT_LT((found.torque.at(0) - Vec3(0, -weight / 2, 0)).norm(), 1e-4 * weight);
    }
}

TEST(Supports, CarryLoadsAndTorquesAtTheEndAndAtTheNodeItself) {
  Scene scene = stiff_cantilever(8);
  const Vec3 push(0.2, -3, 5), turn(0.3, 0.8, -0.5), beside(1, 2, 3);
  for (const std::size_t node : {8, 0}) {
    scene.forces.push_back(std::make_shared<PointLoad>(Kind::force, 0, node, push, Signal::constant(1)));
    scene.forces.push_back(std::make_shared<PointLoad>(Kind::torque, 0, node, turn, Signal::constant(1)));
  }
  StaticsOptions options;
  options.last_load = 0.5;
  const Equilibrium found = balanced(System(scene), options);
  const Vec3 arm = test::tip(found);
  EXPECT_LT((found.support.at(0) + 0.5 * 2 * push).norm(), 1e-8);
  EXPECT_LT((found.torque.at(0) + 0.5 * (2 * turn + arm.cross(push))).norm(), 1e-8);
}

TEST(Supports, OfAShaftTwistItBackByGJPhiOverL) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(7, 1e7, 0.02));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back(test::mover(7, Vec3::UnitX(), Vec3::Zero(), 0.5));
  StaticsOptions options;
  options.until = 5.0;  // by 2.5 rad
  const Equilibrium found = balanced(System(scene), options);
  const double torque = 1e7 / 3 * std::numbers::pi / 2 * std::pow(0.02, 4) * 2.5;
  EXPECT_LT((found.torque.at(1) - Vec3(torque, 0, 0)).norm(), 1e-8 * torque);
  EXPECT_LT((found.torque.at(0) + Vec3(torque, 0, 0)).norm(), 1e-8 * torque);
}

TEST(Supports, OfABeamClampedAtBothEndsCarryWLSquaredOver12AtOrderTwo) {
  double error[2];
  for (const int k : {0, 1}) {
    Scene scene = stiff_cantilever(k == 0 ? 16 : 32);
    scene.anchors.push_back({.rod = 0, .node = k == 0 ? 16u : 32u});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kWeight)));
    const Equilibrium found = balanced(System(scene));
    const double weight = kWeight * test::total_mass(scene.rods[0]);
    EXPECT_NEAR(found.support.at(0).z(), weight / 2, 1e-6 * weight);
    EXPECT_NEAR(found.torque.at(0).y(), -found.torque.at(1).y(), 1e-6 * weight);
    error[k] = -found.torque.at(0).y() / weight - 1.0 / 12;
  }
  EXPECT_LT(std::abs(error[1]), 1e-3);
  EXPECT_NEAR(test::order(error[0], error[1]), 2.0, 0.1);
}

/// An uneven rod that begins at a point.
Rod branch(Random& random, const Vec3& from) {
  Rod rod = test::uneven_rod(random, 5);
  for (std::vector<Vec3>* points : {&rod.p, &rod.q})
    for (Vec3& p : *points) p = rotate_about(Vec3::UnitZ(), 1.0, p) + from;
  rod.q[0] = rod.p[0] + Vec3(0.1, 0.2, 1);
  return rod;
}

/// The two ways to ask agree where nothing moves.
TEST(Supports, AtRestAreThoseOfStatics) {
  Random random(5);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 7));
  for (const auto& [node, position, frame] :
       {std::tuple{0u, true, true}, std::tuple{3u, false, true}, std::tuple{6u, true, false}})
    scene.anchors.push_back({.rod = 0, .node = node, .holds_position = position, .holds_frame = frame});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0.1, 0.2, -0.4)));
  scene.rods.push_back(branch(random, scene.rods[0].p[4]));
  scene.joints.push_back({.parent = 0, .node = 4, .child = 1});
  for (const std::size_t node : {3, 6})
    scene.forces.push_back(test::point_load(Kind::torque, static_cast<int>(node), Vec3(0.2, 0.5, -0.1)));
  // Across the tangent beside the joint: it pushes the parent's node.
  scene.forces.push_back(
      std::make_shared<PointLoad>(Kind::torque, 1, 1, Vec3(0.1, -0.2, 0.3), Signal::constant(1)));
  scene.forces.push_back(test::point_load(Kind::force, 6, Vec3(0.2, 0.5, -0.1)));
  const System system(scene);
  const Equilibrium found = balanced(system);
  Eigen::VectorXd rate;
  ASSERT_TRUE(system.derivative(found.state, 0, found.state.y, rate, *system.make_workspace()).ok());
  EXPECT_LT(rate.cwiseAbs().maxCoeff(), 1e-6);
  const std::vector<Support> supports = supports_of(system, found.state);
  ASSERT_EQ(supports.size(), 3u);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_LT((supports[a].force - found.support[a]).norm(), 1e-7) << a;
    EXPECT_LT((supports[a].torque - found.torque[a]).norm(), 1e-7) << a;
    EXPECT_EQ(supports[a].force.isZero(0.0), !scene.anchors[a].holds_position);
    EXPECT_EQ(supports[a].torque.isZero(0.0), !scene.anchors[a].holds_frame);
  }
}

/// Swings about the origin and shifts, all of it smooth.
Anchor swinging(std::size_t rod, std::size_t node, const Rod& of) {
  Anchor anchor{rod, node, true, true, {}};
  const Vec3 p = of.p[node];
  const Frame frame = node_frames(of.p, of.q).frame[node];
  anchor.period = 2.0;
  anchor.motion = [=](double t) {
    const Vec3 axis = Vec3(1, 2, -0.5).normalized(), way(0.1, -0.2, 0.15);
    const double angle = 0.3 * std::sin(std::numbers::pi * t),
                 rate = 0.3 * std::numbers::pi * std::cos(std::numbers::pi * t);
    const auto turned = [&](const Vec3& v) { return rotate_about(axis, angle, v); };
    return AnchorPose{
        turned(p) + std::sin(std::numbers::pi * t) * way,
        {turned(frame.x), turned(frame.y), turned(frame.z)},
        (rate * axis).cross(turned(p)) + std::numbers::pi * std::cos(std::numbers::pi * t) * way,
        rate * axis};
  };
  return anchor;
}

struct Change {
  Vec3 linear, angular;
};

/// How the momenta change, by a difference along the motion.
Change change_of_momentum(const System& system, const State& state, double h) {
  const auto work = system.make_workspace();
  Eigen::VectorXd rate;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) throw std::runtime_error("no rate");
  test::Momentum side[2];
  for (const int s : {0, 1}) {
    State there = state;
    const double step = s == 0 ? -h : h;
    there.y += step * rate;
    there.time += step;
    if (!system.rebase(there, *work).ok()) throw std::runtime_error("no frames");
    side[s] = test::momentum(system, there);
  }
  return {(side[1].linear - side[0].linear) / (2 * h), (side[1].angular - side[0].angular) / (2 * h)};
}

/// A viscous branched scene, stirred, whose stem is held at three nodes that move, with all kinds of loads.
TEST(Supports, BalanceBothMomentaOfAWholeMovingScene) {
  Random random(17);
  Scene scene;
  scene.twist = Scene::Twist::everywhere;
  scene.rods.push_back(test::uneven_rod(random, 8));
  scene.rods.push_back(branch(random, scene.rods[0].p[3]));
  scene.rods[0].viscosity = 0.02;
  scene.joints.push_back({.parent = 0, .node = 3, .child = 1});
  for (const std::size_t node : {0, 3, 7}) scene.anchors.push_back(swinging(0, node, scene.rods[0]));
  scene.anchors[2].holds_frame = false;
  scene.anchors[2].slide = Anchor::Slide::line;
  scene.anchors[2].slide_axis = Vec3(1, -2, 1);
  scene.anchors[1].slide = Anchor::Slide::plane;
  scene.anchors.push_back(swinging(1, 2, scene.rods[1]));
  scene.anchors[3].holds_position = false;
  const Vec3 g(0.3, -0.2, -1.1), push(0.5, 0.2, -0.7), turn(0.4, -0.6, 0.9);
  scene.forces.push_back(std::make_shared<Gravity>(g));
  scene.forces.push_back(std::make_shared<PointLoad>(Kind::force, 0, 7, push, Signal::constant(1)));
  scene.forces.push_back(std::make_shared<PointLoad>(Kind::torque, 0, 0, turn, Signal::constant(1)));
  scene.forces.push_back(std::make_shared<PointLoad>(Kind::torque, 1, 3, turn, Signal::constant(1)));
  const System system(scene);
  State state = test::stirred(system, random, 0.05);
  state.time = 0.3;
  ASSERT_TRUE(system.rebase(state, *system.make_workspace()).ok());

  Change done = {push, test::at(state.y, 7).cross(push) + 2 * turn};
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t i = 0; i < scene.rods[r].p.size(); ++i) {
      const Vec3 weight = scene.rods[r].mass[i] * g;
      done.linear += weight;
      done.angular += test::at(state.y, system.rods()[r].first + i).cross(weight);
    }
  const std::vector<Support> supports = supports_of(system, state);
  ASSERT_EQ(supports.size(), 4u);
  for (std::size_t a = 0; a < 4; ++a) {
    const std::size_t node = system.rods()[scene.anchors[a].rod].first + scene.anchors[a].node;
    done.linear += supports[a].force;
    done.angular += supports[a].torque + test::at(state.y, node).cross(supports[a].force);
  }
  const Change is = change_of_momentum(system, state, 1e-5);
  const double scale = supports[0].force.norm() + supports[1].force.norm();
  EXPECT_LT((is.linear - done.linear).norm(), 1e-7 * scale);
  EXPECT_LT((is.angular - done.angular).norm(), 1e-7 * scale);
}

TEST(Supports, OfAHingeThatSwingsCarryWhatTheRodsMassesNeed) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e6, 0.02));
  scene.anchors.push_back(swinging(0, 0, scene.rods[0]));
  scene.anchors[0].holds_frame = false;
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kWeight)));
  const System system(scene);
  Simulation simulation(system, system.rest_state(), {.tolerance = 1e-9});
  const double h = 1e-4;
  ASSERT_EQ(simulation.run(0.5 - h).stop, Stop::finished);
  const Vec3 before = test::momentum(system, simulation.state()).linear;
  simulation.run(0.5);
  const Support support = supports_of(system, simulation.state()).at(0);
  simulation.run(0.5 + h);
  const Vec3 after = test::momentum(system, simulation.state()).linear;
  const Vec3 needed = (after - before) / (2 * h) + Vec3(0, 0, kWeight * test::total_mass(scene.rods[0]));
  EXPECT_LT((support.force - needed).norm(), 1e-4 * needed.norm());
  EXPECT_EQ(support.torque, Vec3(Vec3::Zero()));
}

TEST(Supports, DoNothingOnceTheyHaveLetGo) {
  Scene scene = stiff_cantilever(4);
  scene.anchors[0].until = 0.1;
  scene.anchors.push_back({.rod = 0, .node = 4, .holds_frame = false});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -kWeight)));
  const System system(scene);
  State state = system.rest_state();
  EXPECT_GT(supports_of(system, state).at(0).force.z(), 0.0);
  state.time = 0.1;
  const std::vector<Support> after = supports_of(system, state);
  EXPECT_TRUE(after.at(0).force.isZero(0.0) && after.at(0).torque.isZero(0.0));
  // A straight unloaded bar about to swing about its other end: that end carries its own mass alone.
  EXPECT_NEAR(after.at(1).force.z(), kWeight * scene.rods[0].mass[4], 1e-9);
}

}  // namespace
}  // namespace tendril
