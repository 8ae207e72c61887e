#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/rodas.h>
#include <tendril/dynamics/simulation.h>

#include "support/order.h"
#include "support/rods.h"

namespace tendril {
namespace {

using test::order_of;

/// A clamped rod let go under gravity; anisotropic ones keep their twist.
System hanging(int edges, double young, bool twist, double viscosity = 0.0) {
  Scene scene;
  const std::vector<Vec3> p = test::straight(edges, 1.0);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3(0, 0.5, 1), 0.1), {young, young / 3, 1000},
                                elliptic_section(0.02, twist ? 0.012 : 0.02)));
  scene.rods[0].viscosity = viscosity;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  return System(scene);
}

TEST(Rodas, ConvergesAtOrderFourWithoutTwist) {
  const System system = hanging(8, 1e5, false);
  ASSERT_EQ(system.twist_count(), 0u);
  EXPECT_NEAR(order_of(system, system.rest_state(), 0.4, 200), 4.0, 0.3);
}

TEST(Rodas, ConvergesAtOrderFourWithTwist) {
  const System system = hanging(8, 1e5, true);
  ASSERT_EQ(system.twist_count(), 9u);
  EXPECT_NEAR(order_of(system, system.rest_state(), 0.4, 200), 4.0, 0.3);
}

TEST(Rodas, ConvergesAtOrderFourInWindAndWithAMovedClamp) {
  Scene scene = hanging(6, 1e5, true).scene();
  WindOptions wind;
  wind.mean = Vec3(0, 5, 0);
  wind.gust = 0.5;
  scene.forces.push_back(std::make_shared<Wind>(wind));
  scene.rods[0].mass_damping = 0.4;
  const Frame rest = node_frames(scene.rods[0].p, scene.rods[0].q).frame[0];
  scene.anchors[0].motion = [rest](double t) {
    AnchorPose pose;
    pose.position = Vec3(0, 0, 0.1 * std::sin(3 * t));
    pose.velocity = Vec3(0, 0, 0.3 * std::cos(3 * t));
    pose.frame = rest;
    return pose;
  };
  const System system(scene);
  EXPECT_NEAR(order_of(system, system.rest_state(), 0.4, 200), 4.0, 0.35);
}

TEST(Rodas, ConvergesAtOrderFourWhenStronglyViscous) {
  const System system = hanging(8, 1e5, true, 0.05);
  EXPECT_NEAR(order_of(system, system.rest_state(), 0.4, 100), 4.0, 0.35);
}

/// What damping takes out is summed up as well as the motion is known. (What it takes out of spins, which the
/// angles' differences tell only to the second order, is beside that next to nothing.)
TEST(Rodas, CountsWorkAtOrderFour) {
  Scene scene = hanging(8, 1e5, false).scene();
  scene.rods[0].mass_damping = 2.0;
  const System system(scene);
  const auto work = system.make_workspace();
  const auto imbalance = [&](int steps) {
    State state = system.rest_state();
    const double before = system.energies(state, *work).total() - state.y[state.y.size() - 1];
    Rodas rodas(system);
    for (int i = 0; i < steps; ++i)
      if (!rodas.advance(state, 0.4 / steps).ok()) throw std::runtime_error("step failed");
    return std::abs(system.energies(state, *work).total() - state.y[state.y.size() - 1] - before);
  };
  const double first = imbalance(400), second = imbalance(800);
  std::printf("RODAS, damped: energy off by %.2e %.2e, order %.2f\n", first, second,
              std::log2(first / second));
  EXPECT_GT(std::log2(first / second), 3.5);
}

TEST(Rodas, AgreesWithCashKarpOnAStiffRodInFarFewerSteps) {
  const System system = hanging(32, 1e8, true, 1e-4);
  Eigen::VectorXd end[2];
  long steps[2];
  int k = 0;
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    SimulationOptions options;
    options.method = method;
    options.tolerance = 1e-4;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(0.2);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    std::printf("E 1e8, %s: %ld steps, %ld evaluations, imbalance %.1e\n", report.method.c_str(),
                report.accepted, report.evaluations, report.imbalance);
    end[k] = simulation.state().y.head(99);
    steps[k++] = report.accepted;
  }
  EXPECT_LT((end[0] - end[1]).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(steps[1], steps[0] / 10);
}

/// The viscous forces of stiff edges turn with them. An implicit step that does not know so is drawn off its
/// way a little each time, and needs a hundred times as many.
TEST(Rodas, TurnsWithViscousEdges) {
  Scene scene = hanging(15, 1e6, true, 1e-2).scene();
  Eigen::VectorXd end[2];
  int k = 0;
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    const System system(scene);
    SimulationOptions options;
    options.method = method;
    options.tolerance = 1e-6;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(0.3);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    std::printf("viscous rod, %s: %ld steps\n", report.method.c_str(), report.accepted);
    if (method == Method::rodas) EXPECT_LT(report.accepted, 400);
    end[k++] = simulation.state().y.head(48);
  }
  std::printf("viscous rod: RODAS against Cash-Karp %.1e\n", (end[0] - end[1]).cwiseAbs().maxCoeff());
  EXPECT_LT((end[0] - end[1]).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Rodas, FinishesWhereTheGuardRefuses) {
  const System system = hanging(64, 1e10, false);
  SimulationOptions options;
  options.method = Method::cash_karp;
  options.tolerance = 1e-3;
  options.work_limit = 1'000'000;
  EXPECT_EQ(Simulation(system, system.rest_state(), options).run(1.0).stop, Stop::too_stiff);
  options.method = Method::rodas;
  Simulation simulation(system, system.rest_state(), options);
  const Report report = simulation.run(1.0);
  EXPECT_EQ(report.stop, Stop::finished) << report.reason;
  // Nearly rigid: the tip sags by q L^4 / 8 E I and rings about it.
  const double sag = 1000 * 9.81 / (8 * 1e10 * 0.02 * 0.02 / 4);
  EXPECT_LT(std::abs(test::at(simulation.state().y, 64).z()), 2.1 * sag);
  EXPECT_GT(std::abs(test::at(simulation.state().y, 64).z()), 0.3 * sag);
  std::printf("E 1e10, 64 edges: %ld steps, tip %.3e of sag %.3e\n", report.accepted,
              test::at(simulation.state().y, 64).z(), sag);
}

/// A stem with two branches, and a twig on a branch's root.
Scene bush(bool reaction) {
  Scene scene = hanging(6, 1e5, true).scene();
  const auto grow = [&](std::size_t parent, std::size_t node, const Vec3& along) {
    std::vector<Vec3> p = test::straight(4, 0.4);
    for (Vec3& at : p) at = scene.rods[parent].p[node] + at.norm() * along.normalized();
    Rod rod = make_rod(p, orientation_towards(p, Vec3(0.3, 0.2, 1), 0.1), {4e4, 1e4, 500},
                       elliptic_section(0.012, 0.008));
    scene.joints.push_back({parent, node, scene.rods.size(), reaction});
    scene.rods.push_back(std::move(rod));
  };
  grow(0, 3, Vec3(0.2, 1, 0.3));
  grow(0, 6, Vec3(1, -0.5, 0.2));
  grow(1, 0, Vec3(-0.3, -1, 0.1));
  return scene;
}

TEST(Rodas, ConvergesAtOrderFourOnTrees) {
  for (const bool reaction : {true, false}) {
    const System system(bush(reaction));
    EXPECT_NEAR(order_of(system, system.rest_state(), 0.2, 200), 4.0, 0.35) << reaction;
  }
}

TEST(Rodas, ConvergesAtOrderFourOnAViscousTreeShakenByHand) {
  for (const bool reaction : {true, false}) {
    Scene scene = bush(reaction);
    for (Rod& rod : scene.rods) rod.viscosity = 0.02;
    const Frame rest = node_frames(scene.rods[0].p, scene.rods[0].q).frame[0];
    scene.anchors[0].motion = [rest](double t) {
      const auto turned = [t](const Vec3& v) {
        return rotate_about(Vec3::UnitX(), 0.5 * std::sin(4 * t), v);
      };
      AnchorPose pose;
      pose.frame = {turned(rest.x), turned(rest.y), turned(rest.z)};
      pose.angular_velocity = 2 * std::cos(4 * t) * Vec3::UnitX();
      return pose;
    };
    const System system(scene);
    EXPECT_NEAR(order_of(system, system.rest_state(), 0.2, 100), 4.0, 0.35) << reaction;
  }
}

TEST(Rodas, AgreesWithCashKarpOnATree) {
  Scene scene = bush(true);
  scene.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::torque, 2, 3, Vec3(0.002, 0.001, 0),
                                                     Signal::constant(1.0)));
  scene.rods[1].viscosity = 1e-3;
  const System system(scene);
  Eigen::VectorXd end[2];
  int k = 0;
  for (const Method method : {Method::cash_karp, Method::rodas}) {
    SimulationOptions options;
    options.method = method;
    options.tolerance = 1e-7;
    Simulation simulation(system, system.rest_state(), options);
    const Report report = simulation.run(0.3);
    ASSERT_EQ(report.stop, Stop::finished) << report.reason;
    EXPECT_LT(std::abs(report.imbalance), 1e-4);
    end[k++] = simulation.state().y.head(3 * static_cast<Eigen::Index>(system.node_count()));
  }
  std::printf("tree: RODAS against Cash-Karp %.1e\n", (end[0] - end[1]).cwiseAbs().maxCoeff());
  EXPECT_LT((end[0] - end[1]).cwiseAbs().maxCoeff(), 2e-6);
}

}  // namespace
}  // namespace tendril
