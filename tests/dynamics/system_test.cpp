#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/cash_karp.h>
#include <tendril/dynamics/forces.h>

#include "support/rods.h"

namespace tendril {
namespace {

std::string refused(const std::function<void(Scene&)>& spoil) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e6, 0.01));
  spoil(scene);
  return test::place_of_refusal(scene);
}

TEST(SystemInput, IsRefusedWithThePlace) {
  EXPECT_EQ(refused([](Scene&) {}), "accepted");
  EXPECT_EQ(refused([](Scene& s) { s.rods.clear(); }), "rods");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].mass[2] = 0; }), "rods[0].mass[2]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].mass.pop_back(); }), "rods[0].mass");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].inertia[1] = -1; }), "rods[0].inertia[1]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].twist[3] = std::nan(""); }), "rods[0].twist[3]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].stretch[0] = HUGE_VAL; }), "rods[0].stretch[0]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].viscosity = -1; }), "rods[0].viscosity[0]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].p[2].x() = std::nan(""); }), "rods[0].p or q[2]");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].q[1] = s.rods[0].p[1]; }), "rods[0] node 1");
  EXPECT_EQ(refused([](Scene& s) { s.rods[0].p[2] = s.rods[0].p[1]; }), "rods[0] node 1");
  EXPECT_EQ(refused([](Scene& s) { s.anchors.push_back({1, 0, true, true, {}}); }), "anchors[0].rod");
  EXPECT_EQ(refused([](Scene& s) { s.anchors.push_back({0, 5, true, true, {}}); }), "anchors[0].node");
  EXPECT_EQ(refused([](Scene& s) { s.anchors.assign(2, {0, 1, true, true, {}}); }), "anchors[1].node");
  EXPECT_EQ(refused([](Scene& s) { s.forces.emplace_back(nullptr); }), "forces[0]");
  EXPECT_EQ(
      refused([](Scene& s) { s.forces.push_back(std::make_shared<PullTowards>(0, 9, Vec3::Zero(), 1.0)); }),
      "node");
}

TEST(TwistState, IsKeptOnlyWhereTheSceneTwists) {
  const auto states = [](const std::function<void(Scene&)>& change) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(4, 1e6, 0.01));
    change(scene);
    return System(scene).twist_count();
  };
  EXPECT_EQ(states([](Scene&) {}), 0u);
  EXPECT_EQ(states([](Scene& s) { s.anchors.push_back({0, 0, true, true, {}}); }), 0u);
  EXPECT_EQ(states([](Scene& s) { s.twist = Scene::Twist::everywhere; }), 5u);
  EXPECT_EQ(states([](Scene& s) { s.rods[0].bend_l[2] *= 2; }), 5u);
  EXPECT_EQ(states([](Scene& s) { s.rods[0].viscosity = 1e-3; }), 5u);
  EXPECT_EQ(states([](Scene& s) { s.rods[0].p[2].y() += 0.01; }), 5u);
  EXPECT_EQ(states([](Scene& s) { s.anchors = {{0, 0, true, true, {}}, {0, 4, false, true, {}}}; }), 5u);
  EXPECT_EQ(states([](Scene& s) {
              s.forces.push_back(std::make_shared<PointLoad>(PointLoad::Kind::torque, 0, 2, Vec3::UnitX(),
                                                             Signal::constant(1)));
            }),
            5u);
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e6, 0.01));
  EXPECT_EQ(System(scene).left_out().size(), 4u);
}

TEST(TwistState, LeftOutGivesTheSamePlanarMotion) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(8, 1e5, 0.01));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  Eigen::VectorXd end[2];
  for (const bool everywhere : {false, true}) {
    scene.twist = everywhere ? Scene::Twist::everywhere : Scene::Twist::where_needed;
    const System system(scene);
    State state = system.rest_state();
    CashKarp stepper(system);
    for (int i = 0; i < 2000; ++i) ASSERT_TRUE(stepper.advance(state, 2e-4).ok());
    end[everywhere] = state.y.head(27);
  }
  EXPECT_GT((end[0] - System(scene).rest_state().y.head(27)).norm(), 0.1);
  EXPECT_LT((end[0] - end[1]).norm(), 1e-11);
}

TEST(RestState, StaysAtRestWhateverItsShape) {
  test::Random random(3);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 10));
  scene.rods.push_back(test::uneven_rod(random, 4));
  scene.anchors = {{0, 0, true, true, {}}, {0, 6, true, true, {}}, {1, 2, true, false, {}}};
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  const State state = system.rest_state();
  const auto work = system.make_workspace();
  Eigen::VectorXd dy;
  ASSERT_TRUE(system.derivative(state, 0.0, state.y, dy, *work).ok());
  EXPECT_LT(dy.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(system.energies(state, *work).total(), 1e-25);
  const std::vector<Vec3> q = system.orientation_masses(state, *work);
  for (std::size_t i = 0; i < q.size(); ++i)
    EXPECT_LT((q[i] - (i < 10 ? scene.rods[0].q[i] : scene.rods[1].q[i - 10])).norm(), 1e-14);
}

TEST(Twist, IsFollowedBeyondHalfATurn) {
  // One end held, the other end's frame turned three times round: the twist between them remembers.
  Scene scene;
  scene.rods.push_back(test::straight_rod(1, 1e6, 0.02));
  scene.anchors.push_back({0, 0, true, true, {}});
  Anchor turning{0, 1, true, true, {}};
  turning.motion = [](double t) {
    AnchorPose pose;
    pose.position = Vec3(1, 0, 0);
    pose.frame.z = Vec3::UnitX();
    pose.frame.y = rotate_about(Vec3::UnitX(), t, Vec3::UnitZ());
    pose.frame.x = pose.frame.y.cross(pose.frame.z);
    pose.angular_velocity = Vec3::UnitX();
    return pose;
  };
  scene.anchors.push_back(turning);
  const System system(scene);
  State state = system.rest_state();
  CashKarp stepper(system);
  const double turns = 6 * std::numbers::pi;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(stepper.advance(state, turns / 100).ok());
  EXPECT_NEAR(state.twist[0], turns, 1e-12);
  const double energy = system.energies(state, stepper.workspace()).elastic;
  EXPECT_NEAR(energy / (0.5 * scene.rods[0].twist[0] * turns * turns), 1.0, 1e-12);
  // All of it was work of the turning anchor.
  EXPECT_NEAR(state.y[state.y.size() - 1] / energy, 1.0, 1e-10);
}

TEST(Signals, TakeTheirValues) {
  EXPECT_EQ(Signal::constant(3)(7.0), 3.0);
  EXPECT_NEAR(Signal::sinusoid(2, 0.25, 0.0, 1)(1.0), 3.0, 1e-15);
  const Signal table = Signal::table({{0, 1}, {1, 3}, {1, 10}, {2, 0}});
  EXPECT_EQ(table(-1), 1);
  EXPECT_EQ(table(0.5), 2);
  EXPECT_EQ(table(1.0), 10);
  EXPECT_EQ(table(1.5), 5);
  EXPECT_EQ(table(9), 0);
  EXPECT_THROW(Signal::table({}), InvalidInput);
  EXPECT_THROW(Signal::table({{1, 0}, {0, 0}}), InvalidInput);
  EXPECT_THROW(Signal::constant(std::nan("")), InvalidInput);
}

TEST(Drag, OpposesMotionThroughTheAir) {
  WindOptions options;
  options.mean = Vec3(0, 2, 0);
  options.normal_drag = 1.5;
  options.tangential_drag = 0.1;
  options.air_density = 1.3;
  const Wind wind(options);
  const std::vector<Vec3> p{{0, 0, 0}, {0.5, 0, 0}};
  const std::vector<Vec3> v{{3, 0, 0}, {3, 0, 0}};
  const std::vector<double> ones(2, 1.0);
  const std::vector<double> width(2, 0.2);
  const std::vector<NodeRange> rods{{0, 2}};
  std::vector<Vec3> force(2, Vec3::Zero());
  std::vector<Vec3> torque = force;
  wind.add({0.0, p, v, v, ones, ones, width, rods}, {force, torque});
  // Relative motion: 3 along the edge, -2 across it; area 0.2 * 0.5.
  const double q = 0.5 * 1.3 * 0.2 * 0.5;
  EXPECT_NEAR((force[0] + force[1] - q * Vec3(-0.1 * 9, 1.5 * 4, 0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(force[0], force[1]);
}

TEST(Gusts, AreCarriedByTheWindAndRepeat) {
  WindOptions options;
  options.mean = Vec3(4, 0, 0);
  options.gust = 0.5;
  const Wind wind(options);
  // Frozen turbulence: what is here now is 4 further downwind a time unit later.
  EXPECT_NEAR((wind.velocity(Vec3(1, 2, 3), 0.3) - wind.velocity(Vec3(5, 2, 3), 1.3)).norm(), 0.0, 1e-13);
  EXPECT_EQ(wind.velocity(Vec3::Zero(), 0.7), Wind(options).velocity(Vec3::Zero(), 0.7));
  double mean = 0.0;
  double square = 0.0;
  const int samples = 200000;
  for (int i = 0; i < samples; ++i) {
    const double u = wind.velocity(Vec3::Zero(), 0.01 * i).x() / 4;
    mean += u / samples;
    square += u * u / samples;
  }
  EXPECT_NEAR(mean, 1.0, 0.01);
  EXPECT_NEAR(std::sqrt(2 * (square - mean * mean)), 0.5, 0.02);
  options.seed = 2;
  EXPECT_NE(wind.velocity(Vec3::Zero(), 0.7), Wind(options).velocity(Vec3::Zero(), 0.7));
}

}  // namespace
}  // namespace tendril
