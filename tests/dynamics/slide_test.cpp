#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/supports.h>

#include "support/equilibria.h"
#include "support/numbers.h"
#include "support/order.h"

namespace tendril {
namespace {

using test::balanced;
using test::kGravity;
using test::Random;
using Slide = Anchor::Slide;

Anchor sliding(std::size_t node, Slide slide, const Vec3& axis, bool holds_frame = false) {
  return {.rod = 0, .node = node, .holds_frame = holds_frame, .slide = slide, .slide_axis = axis};
}

/// Rises from a point at a speed.
std::function<AnchorPose(double)> lifted(const Vec3& from, double speed) {
  return [=](double t) {
    AnchorPose pose;
    pose.velocity = speed * Vec3::UnitZ();
    pose.position = from + t * pose.velocity;
    pose.frame = frame_towards(Vec3::UnitX(), Vec3::UnitY()).frame;
    return pose;
  };
}

std::shared_ptr<const Force> weight() {
  return std::make_shared<Gravity>(Vec3(0, 0, -kGravity));
}

/// A straight rod between two points.
Rod bar(const Vec3& from, const Vec3& to, int edges, double young, double radius) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.emplace_back(from + (to - from) * i / edges);
  return make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {young, young / 3, 1000},
                  circular_section(radius));
}

class Slides : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, Slides,
                         testing::Values(Method::automatic, Method::cash_karp, Method::rodas, Method::verlet,
                                         Method::runge_kutta4, Method::backward_euler, Method::nystrom),
                         [](const auto& method) { return std::string(to_string(method.param)); });

SimulationOptions options_for(Method method, double tolerance, double step) {
  SimulationOptions options;
  options.method = method;
  options.tolerance = tolerance;
  if (!chooses_steps(method)) options.fixed_step = step;
  if (method == Method::backward_euler) options.energy_limit = 0.1;  // it loses some
  return options;
}

/// Both ends on one inclined line: s = 1/2 g sin(angle) t^2, and no support does work.
TEST_P(Slides, ABarDownAnInclinedLineFallsByItsSine) {
  const Vec3 way = Vec3(2, 1, -1).normalized();
  Scene scene;
  scene.rods.push_back(bar(Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3) + way, 1, 1e6, 0.02));
  for (const std::size_t node : {0, 1}) scene.anchors.push_back(sliding(node, Slide::line, 3 * way));
  scene.forces.push_back(weight());
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options_for(GetParam(), 1e-8, 1e-3));
  const Report report = simulation.run(0.5);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  const Vec3 fallen = 0.5 * kGravity * -way.z() * 0.25 * way;
  const double allowed = GetParam() == Method::backward_euler ? 3e-3 : 1e-9;
  for (const std::size_t node : {0, 1}) {
    const Vec3 moved = test::at(simulation.state().y, node) - scene.rods[0].p[node];
    EXPECT_LT((moved - fallen).norm(), allowed * fallen.norm());
    EXPECT_LT((moved - moved.dot(way) * way).norm(), 1e-14);
  }
  EXPECT_EQ(report.work, 0.0);
}

/// A bar whose ends slide on a level and on an upright line swings as a pendulum: with all its masses m at
/// s along it, theta'' = -g sum(m s) / sum(m s^2) sin(theta).
TEST_P(Slides, ALadderOnTwoLinesSwingsAsAPendulum) {
  if (GetParam() == Method::backward_euler) return;  // of order 1 alone
  const double start = 1.0, length = 0.7;
  Scene scene;
  scene.rods.push_back(
      bar(Vec3(length * std::sin(start), 0, 0), Vec3(0, 0, -length * std::cos(start)), 3, 1e8, 0.1));
  scene.anchors.push_back(sliding(0, Slide::line, Vec3::UnitX()));
  scene.anchors.push_back(sliding(3, Slide::line, Vec3::UnitZ()));
  scene.forces.push_back(weight());
  double first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double s = length * static_cast<double>(i) / 3;
    first += scene.rods[0].mass[i] * s;
    second += scene.rods[0].mass[i] * s * s;
  }
  double angle = start, rate = 0.0;
  const double end = 1.3, h = end / 20000;
  const auto pull = [&](double a) { return -kGravity * first / second * std::sin(a); };
  for (int i = 0; i < 20000; ++i) {  // leapfrog
    rate += 0.5 * h * pull(angle);
    angle += h * rate;
    rate += 0.5 * h * pull(angle);
  }
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options_for(GetParam(), 1e-6, 2e-5));
  const Report report = simulation.run(end);
  ASSERT_EQ(report.stop, Stop::finished) << report.reason;
  EXPECT_LT(std::abs(report.imbalance), 1e-4);
  EXPECT_LT(std::abs(angle - start), 2.0 * start);  // it has swung
  // It bends by some 1e-4 of its length.
  EXPECT_LT((test::at(simulation.state().y, 0) - Vec3(length * std::sin(angle), 0, 0)).norm(), 1e-3 * length);
  EXPECT_LT((test::at(simulation.state().y, 3) - Vec3(0, 0, -length * std::cos(angle))).norm(),
            1e-3 * length);
}

/// All kinds at once, without and with twist and viscosity, on sliders that their poses carry along.
Scene shaken(bool twist) {
  Random random(23);
  Scene scene;
  scene.rods.push_back(twist ? test::uneven_rod(random, 6) : bar(Vec3(0, 0, 0), Vec3(4, 1, 1), 5, 1e4, 0.1));
  if (twist) scene.rods[0].viscosity = 0.05;
  scene.rods[0].mass_damping = 0.2;
  const NodeFrames frames = node_frames(scene.rods[0].p, scene.rods[0].q);
  for (const auto& [node, slide, frame] :
       {std::tuple{0u, Slide::plane, twist}, std::tuple{3u, Slide::line, false}}) {
    Anchor anchor = sliding(node, slide, Vec3(1, 2, node == 3 ? 0.5 : -1.5), frame);
    anchor.period = 2 * std::numbers::pi / 3;
    anchor.motion = [p = scene.rods[0].p[node], f = frames.frame[node]](double t) {
      AnchorPose pose;
      pose.position = p + std::sin(3 * t) * Vec3(0.1, 0.05, -0.1);
      pose.velocity = 3 * std::cos(3 * t) * Vec3(0.1, 0.05, -0.1);
      pose.frame = f;
      return pose;
    };
    scene.anchors.push_back(anchor);
  }
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0.3, -0.2, -1)));
  scene.forces.push_back(test::point_load(PointLoad::Kind::force, 5, Vec3(0.2, 0.5, -0.1)));
  WindOptions wind;
  wind.mean = Vec3(0.3, 1, 0);
  scene.forces.push_back(std::make_shared<Wind>(wind));
  return scene;
}

TEST(Sliding, KeepsRodasAtOrderFour) {
  for (const bool twist : {false, true}) {
    const System system(shaken(twist));
    EXPECT_NEAR(test::order_of(system, system.rest_state(), 0.4, 50), 4.0, 0.35) << twist;
  }
}

TEST(Sliding, IsTheSameMotionByAllMethodsAndBalancesItsEnergy) {
  for (const bool twist : {false, true}) {
    const Scene scene = shaken(twist);
    const System system(scene);
    std::vector<Vec3> ends;
    for (const Method method : {Method::cash_karp, Method::rodas, Method::runge_kutta4}) {
      Simulation simulation(system, system.rest_state(), options_for(method, 1e-9, 1e-3));
      const Report report = simulation.run(1.5);
      ASSERT_EQ(report.stop, Stop::finished) << report.reason;
      EXPECT_LT(std::abs(report.imbalance), 1e-6) << to_string(method);
      EXPECT_GT(std::abs(report.work), 0.0);
      const State& state = simulation.state();
      ends.push_back(test::at(state.y, 5));
      for (const Anchor& anchor : scene.anchors) {
        const Vec3 off = test::at(state.y, anchor.node) - anchor.motion(state.time).position;
        const Vec3 axis = anchor.slide_axis.normalized();
        EXPECT_GT(off.norm(), 1e-3);
        EXPECT_LT(anchor.slide == Slide::line ? off.cross(axis).norm() : std::abs(off.dot(axis)), 1e-13);
      }
      const std::vector<Support> supports = supports_of(system, state);
      const Vec3 plane = scene.anchors[0].slide_axis.normalized();
      const Vec3 line = scene.anchors[1].slide_axis.normalized();
      EXPECT_LT(supports[0].force.cross(plane).norm(), 1e-13 * supports[0].force.norm());
      EXPECT_LT(std::abs(supports[1].force.dot(line)), 1e-13 * supports[1].force.norm());
    }
    EXPECT_LT((ends[0] - ends[1]).norm(), 1e-6);
    EXPECT_LT((ends[0] - ends[2]).norm(), 1e-6);
  }
}

/// Simply supported on a fixed hinge and on a roller that may move along the beam: 5 w L^4 / 384 E I, w L / 2
/// each.
TEST(Sliding, CarriesABeamOnRollers) {
  double error[2];
  for (const int k : {0, 1}) {
    const std::size_t edges = k == 0 ? 16 : 32;
    Scene scene;
    scene.rods.push_back(bar(Vec3::Zero(), Vec3(0.6, 0.8, 0), static_cast<int>(edges), 1e10, 0.01));
    scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = false});
    scene.anchors.push_back(sliding(edges, Slide::plane, Vec3::UnitZ()));
    // Across the beam it would turn about the hinge.
    scene.anchors.push_back(sliding(edges / 2, Slide::plane, Vec3(-0.8, 0.6, 0)));
    scene.forces.push_back(weight());
    const Equilibrium found = balanced(System(scene));
    const double load = kGravity * test::total_mass(scene.rods[0]);
    const double bending = 1e10 * std::numbers::pi / 4 * 1e-8;
    error[k] = -test::at(found.state.y, edges / 2).z() / (5 * load / (384 * bending)) - 1.0;
    for (const std::size_t a : {0, 1})
      EXPECT_LT((found.support[a] - Vec3(0, 0, load / 2)).norm(), 1e-5 * load) << a;
    EXPECT_LT(found.support[2].norm(), 1e-6 * load);
    EXPECT_TRUE(found.torque[1].isZero(0.0));
    EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
  }
  EXPECT_LT(std::abs(error[1]), 3e-3);
  EXPECT_NEAR(test::order(error[0], error[1]), 2.0, 0.2);
}

/// A torque M about y at the end on a roller whose line rises by an angle a: M / (L cos a) square to it.
TEST(Sliding, CarriesATorqueAtAnObliqueRoller) {
  const double slope = 0.4, turn = 0.05;
  Scene scene;
  scene.rods.push_back(bar(Vec3::Zero(), Vec3(1, 0, 0), 12, 1e9, 0.01));
  scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = false});
  scene.anchors.push_back(sliding(12, Slide::line, Vec3(std::cos(slope), 0, std::sin(slope))));
  scene.forces.push_back(test::point_load(PointLoad::Kind::torque, 12, Vec3(0, turn, 0)));
  const Equilibrium found = balanced(System(scene));
  const Vec3 end = test::tip(found);
  const Vec3 push = found.support[1];
  EXPECT_LT(std::abs(push.x() * std::cos(slope) + push.z() * std::sin(slope)), 1e-9 * turn);
  EXPECT_LT((end.cross(push) + Vec3(0, turn, 0)).norm(), 1e-8 * turn);
  EXPECT_LT((found.support[0] + push).norm(), 1e-8 * turn);
  EXPECT_NEAR(push.norm() / (turn / std::cos(slope)), 1.0, 2e-3);
}

/// A guided end (its frame held, free to slide across the rod) is a clamp that sinks: P L^3 / 12 E I.
TEST(Sliding, GuidesAClampThatSinksByAQuarterOfACantilever) {
  Scene scene;
  scene.rods.push_back(bar(Vec3::Zero(), Vec3(1, 0, 0), 40, 1e10, 0.01));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back(sliding(40, Slide::plane, Vec3::UnitX(), true));
  const double bending = 1e10 * std::numbers::pi / 4 * 1e-8, load = 0.1;
  scene.forces.push_back(test::point_load(PointLoad::Kind::force, 40, Vec3(0, 0, -load)));
  const Equilibrium found = balanced(System(scene));
  EXPECT_NEAR(-test::tip(found).z() / (load / (12 * bending)), 1.0, 2e-3);
  EXPECT_NEAR(found.torque[0].y(), -load / 2, 1e-4 * load);
  EXPECT_NEAR(found.torque[1].y(), -load / 2, 1e-4 * load);
  EXPECT_LT(std::abs(found.support[1].z()), 1e-12);
}

/// Two bars that hang from a pin and from a roller on a slope, a load where they meet: the roller rolls until
/// its bar is square to the slope, and the bars pull as the method of joints says.
TEST(Sliding, CarriesATrussOnAnObliqueRoller) {
  const double slope = 0.3, side = std::sqrt(2.0), load = 3.0;
  const Vec3 along(std::cos(slope), 0, -std::sin(slope)), normal(std::sin(slope), 0, std::cos(slope));
  Scene scene;
  for (const Vec3& end : {Vec3(0, 0, 0), Vec3(2, 0, 0)}) {
    const Vec3 foot(1, 0, -1);
    scene.rods.push_back(end.x() == 0 ? bar(end, foot, 1, 1e9, 0.01) : bar(foot, end, 1, 1e9, 0.01));
    test::keep(scene.rods.back(), test::Keep::stretch);
  }
  scene.joints.push_back({.parent = 0, .node = 1, .child = 1});
  scene.anchors.push_back({.rod = 0, .node = 0, .holds_frame = false});
  scene.anchors.push_back(sliding(1, Slide::line, along));
  scene.anchors[1].rod = 1;
  scene.forces.push_back(test::point_load(PointLoad::Kind::force, 1, Vec3(0, 0, -load)));
  const Equilibrium found = find_equilibrium(System(scene), System(scene).rest_state());
  ASSERT_EQ(found.balance, Balance::converged) << found.reason;
  // The foot is as far from the line as the bar is long, and from the pin as the other is.
  const double away = Vec3(2, 0, 0).dot(normal) - side;  // of the foot from the pin, along the normal
  const Vec3 foot = away * normal + std::sqrt(2.0 - away * away) * along;
  EXPECT_LT((test::at(found.state.y, 1) - foot).norm(), 1e-4);
  EXPECT_LT((test::at(found.state.y, 3) - (foot + side * normal)).norm(), 1e-4);
  // T_1 u + T_2 n = load z
  const Vec3 u = -foot / side;
  const double det = u.x() * normal.z() - u.z() * normal.x();
  const double pull = -normal.x() * load / det, hold = u.x() * load / det;
  EXPECT_LT((found.support[0] - pull * u).norm(), 1e-4 * load);
  EXPECT_LT((found.support[1] - hold * normal).norm(), 1e-4 * load);
}

/// What nothing resists is neutral, and a load along it is told by name.
TEST(Sliding, IsNeutralAlongALineAndHoldsNothingThere) {
  Scene scene;
  scene.rods.push_back(bar(Vec3::Zero(), Vec3(0.6, 0, 0.8), 6, 1e8, 0.02));
  for (const std::size_t node : {0, 6})
    scene.anchors.push_back(sliding(node, Slide::line, Vec3(0.6, 0, 0.8)));
  const System system(scene);
  const Stability stability = stability_of(system, system.rest_state());
  EXPECT_EQ(stability.kind, Stability::Kind::neutral);
  EXPECT_EQ(stability.neutral, 1);
  scene.forces.push_back(weight());
  EXPECT_EQ(find_equilibrium(System(scene), system.rest_state()).balance, Balance::unheld);
}

/// A statics path: the plane under an end is lifted, the end rolls on it.
TEST(Sliding, IsFollowedAsItsPlaneMoves) {
  Scene scene;
  scene.rods.push_back(bar(Vec3::Zero(), Vec3(1, 0, 0), 24, 1e9, 0.01));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back(sliding(24, Slide::plane, Vec3::UnitZ()));
  scene.anchors[1].motion = lifted(Vec3(7, -3, 0), 0.02);  // only its height counts
  StaticsOptions options;
  options.until = 1.0;
  const Equilibrium found = balanced(System(scene), options);
  EXPECT_NEAR(test::tip(found).z(), 0.02, 1e-12);
  EXPECT_LT(test::tip(found).x(), 1.0 - 1e-5);  // it comes nearer as it bends
  const double bending = 1e9 * std::numbers::pi / 4 * 1e-8;
  EXPECT_NEAR(found.support[1].z() / (3 * bending * 0.02), 1.0, 3e-3);
  EXPECT_LT(std::hypot(found.support[1].x(), found.support[1].y()), 1e-12);
}

/// On the way edges turn and do not stretch: a stiff thin rod's end is brought to where it may slide.
TEST(Sliding, IsFollowedFarInFewStepsHoweverStiffTheRod) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(24, 1e13, 0.002));
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.anchors.push_back(sliding(24, Slide::plane, Vec3(0.3, 0.1, 1)));
  scene.anchors[1].motion = lifted(Vec3::UnitX(), 0.7);
  StaticsOptions options;
  options.until = 1.0;
  const Equilibrium found = balanced(System(scene), options);
  EXPECT_NEAR((test::tip(found) - Vec3(1, 0, 0.7)).dot(Vec3(0.3, 0.1, 1)), 0.0, 1e-12);
  EXPECT_LT(found.iterations, 60);
}

TEST(Sliding, EndsWhereItsAnchorLetsGo) {
  Scene scene;
  scene.rods.push_back(bar(Vec3::Zero(), Vec3(0.5, 0, 0), 2, 1e6, 0.02));
  scene.anchors.push_back(sliding(0, Slide::line, Vec3(1, 0, -1)));
  scene.anchors[0].until = 0.2;
  scene.forces.push_back(weight());
  const System system(scene);
  Simulation simulation(system, system.rest_state(), options_for(Method::automatic, 1e-8, 0));
  ASSERT_EQ(simulation.run(0.2).stop, Stop::finished);
  const Vec3 before = test::momentum(system, simulation.state()).linear;
  ASSERT_EQ(simulation.run(0.5).stop, Stop::finished);
  const Vec3 change = test::momentum(system, simulation.state()).linear - before;
  const Vec3 fall(0, 0, -kGravity * 0.3 * test::total_mass(scene.rods[0]));
  EXPECT_LT((change - fall).norm(), 1e-9 * fall.norm());
}

TEST(Sliding, IsRefusedWithoutAPositionToHoldOrADirection) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e6, 0.02));
  scene.anchors.push_back(sliding(0, Slide::line, Vec3::UnitX(), true));
  EXPECT_EQ(test::place_of_refusal(scene), "accepted");
  scene.anchors[0].holds_position = false;
  EXPECT_EQ(test::place_of_refusal(scene), "anchors[0].slide");
  scene.anchors[0].holds_position = true;
  for (const Vec3& axis : {Vec3(0, 0, 0), Vec3(1, std::nan(""), 0), Vec3(HUGE_VAL, 0, 0)}) {
    scene.anchors[0].slide_axis = axis;
    EXPECT_EQ(test::place_of_refusal(scene), "anchors[0].slide");
  }
}

}  // namespace
}  // namespace tendril
