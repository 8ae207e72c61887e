#include <gtest/gtest.h>
#include <tendril/dynamics/fixed_steppers.h>
#include <tendril/dynamics/forces.h>

#include "support/free_flight.h"

namespace tendril {
namespace {

using test::FreeFlight;
using test::Random;

/// Two masses without springs of their own, each pulled back to its place: oscillators of frequency 1.
struct Oscillators {
  Oscillators() : system(scene()), state(system.rest_state()), work(system.make_workspace()) {
    for (const int k : {2, 5}) state.y[k] = 0.3;
  }
  static Scene scene() {
    Scene result;
    const std::vector<Vec3> p{Vec3::Zero(), Vec3::UnitX()};
    result.rods.push_back(
        make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), SpringConstants{0, 0, 0, 0, 0, 2.0, 1.0}));
    for (std::size_t i = 0; i < 2; ++i)
      result.forces.push_back(std::make_shared<PullTowards>(0, i, p[i], 2.0));
    return result;
  }
  double energy() { return system.energies(state, *work).total(); }
  System system;
  State state;
  System::WorkspacePtr work;
};

TEST(FixedSteppers, AmplifyAnOscillationByTheirClosedForms) {
  // Energy over energy a step at h w = y.
  const auto factor = [](Method method, double y) {
    const double y2 = y * y;
    if (method == Method::explicit_euler) return 1 + y2;
    if (method == Method::backward_euler) return 1 / (1 + y2);
    return 1 - y2 * y2 * y2 / 72 + y2 * y2 * y2 * y2 / 576;
  };
  for (const Method method : {Method::explicit_euler, Method::backward_euler, Method::runge_kutta4})
    for (const double y : {0.1, 0.5, 1.0, 2.5}) {
      Oscillators two;
      const double before = two.energy();
      const auto stepper = make_stepper(method, two.system);
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper->advance(two.state, y).ok());
      EXPECT_NEAR(two.energy() / before / std::pow(factor(method, y), 3), 1.0, 1e-8)
          << stepper->name() << " " << y;
      EXPECT_DOUBLE_EQ(two.state.time, 3 * y);
    }
}

TEST(FixedSteppers, SeeAForceAtTheTimesOfTheirStages) {
  // A force t on a mass of 2 over one step of 0.4: h f(t)/m at the stages' weights.
  Scene scene = Oscillators::scene();
  scene.forces = {std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 1, Vec3::UnitZ(),
                                              Signal::table({{0.0, 0.0}, {1.0, 1.0}}))};
  const System system(scene);
  for (const auto& [method, expected] :
       {std::pair{Method::explicit_euler, 0.0}, std::pair{Method::backward_euler, 0.08},
        std::pair{Method::runge_kutta4, 0.04}, std::pair{Method::verlet, 0.04}}) {
    State state = system.rest_state();
    ASSERT_TRUE(make_stepper(method, system)->advance(state, 0.4).ok());
    EXPECT_NEAR(state.y[6 + 5], expected, 1e-15) << to_string(method);
  }
}

TEST(VelocityVerlet, KeepsTheShadowEnergyOfAnOscillation) {
  // (1 - y^2 / 4) x^2 + v^2 is constant at h w = y.
  for (const double y : {0.1, 1.0, 1.9}) {
    Oscillators two;
    VelocityVerlet stepper(two.system);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(stepper.advance(two.state, y).ok());
    const double x = two.state.y[2];
    const double v = two.state.y[6 + 2];
    EXPECT_NEAR((1 - y * y / 4) * x * x + v * v, (1 - y * y / 4) * 0.09, 1e-12) << y;
    EXPECT_EQ(stepper.evaluations(), 1001) << y;
  }
}

struct Order {
  Method method;
  double order;
  int steps;
};

class EveryFixedStepper : public testing::TestWithParam<Order> {};

TEST_P(EveryFixedStepper, HasItsOrderOnASpinningRod) {
  const auto [method, order, steps] = GetParam();
  const FreeFlight flight;
  const auto work = flight.system.make_workspace();
  const auto shape = [&](const State& state) {
    Eigen::VectorXd out = state.y.head(24);
    for (const Frame& frame : flight.system.frames(state, *work)) {
      out.conservativeResize(out.size() + 3);
      out.tail<3>() = frame.y;
    }
    return out;
  };
  const Eigen::VectorXd reference = shape(flight.run(Method::cash_karp, 3200));
  const double energy = flight.system.energies(flight.state, *work).total();
  double before = 0.0;
  for (const int n : {steps, 2 * steps, 4 * steps}) {
    const State end = flight.run(method, n);
    const double error = (shape(end) - reference).norm();
    const double found = std::log2(before / error);
    std::printf("%s, %d steps: error %.2e, order %.2f, energy %.1e\n", to_string(method), n, error, found,
                flight.system.energies(end, *work).total() / energy - 1);
    if (before > 0.0) EXPECT_NEAR(found, order, 0.1);
    before = error;
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, EveryFixedStepper,
                         testing::Values(Order{Method::explicit_euler, 1, 8000},
                                         Order{Method::backward_euler, 1, 800},
                                         Order{Method::runge_kutta4, 4, 200}, Order{Method::verlet, 2, 400},
                                         Order{Method::nystrom, 3, 200}),
                         [](const auto& one) { return std::string(to_string(one.param.method)); });

TEST(FixedSteppers, OrderByEnergyErrorWhereTheStepResolvesTheMotion) {
  const FreeFlight flight;
  const auto work = flight.system.make_workspace();
  const double energy = flight.system.energies(flight.state, *work).total();
  const auto drift = [&](Method method) {
    return std::abs(flight.system.energies(flight.run(method, 400), *work).total() / energy - 1);
  };
  EXPECT_LT(1e3 * drift(Method::runge_kutta4), drift(Method::verlet));
  EXPECT_LT(1e3 * drift(Method::verlet), drift(Method::backward_euler));
  EXPECT_LT(drift(Method::backward_euler), drift(Method::explicit_euler));
}

/// A stirred chain whose forces depend on positions only.
struct Chain {
  explicit Chain(int edges) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(edges, 1e5, 0.02));
    scene.anchors.push_back({0, 0, true, true, {}});
    scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
    system = std::make_unique<System>(scene);
    Random random(3);
    state = test::stirred(*system, random, 0.3 / edges);
  }
  std::unique_ptr<System> system;
  State state;
};

TEST(VelocityVerlet, ForgetsAStepThatFailed) {
  const Chain chain(4);
  VelocityVerlet stepper(*chain.system);
  State state = chain.state;
  ASSERT_TRUE(stepper.advance(state, 1e-3).ok());
  EXPECT_FALSE(stepper.advance(state, 1e300).ok());
  State again = chain.state;
  State fresh = chain.state;
  ASSERT_TRUE(stepper.advance(again, 1e-3).ok());
  ASSERT_TRUE(VelocityVerlet(*chain.system).advance(fresh, 1e-3).ok());
  EXPECT_TRUE((again.y.array() == fresh.y.array()).all());
}

TEST(Nystrom, HasOrderFiveWhereForcesDependOnPlacesAlone) {
  const Chain chain(8);
  const auto end = [&](Method method, int steps) {
    State state = chain.state;
    const auto stepper = make_stepper(method, *chain.system);
    for (int i = 0; i < steps; ++i)
      if (!stepper->advance(state, 0.2 / steps).ok()) throw std::runtime_error("step failed");
    return Eigen::VectorXd(state.y.head(54));
  };
  const Eigen::VectorXd exact = end(Method::cash_karp, 3200);
  double before = 0.0;
  for (const int steps : {100, 200, 400}) {
    const double error = (end(Method::nystrom, steps) - exact).norm();
    std::printf("nystrom, %d steps: error %.2e, order %.2f\n", steps, error, std::log2(before / error));
    if (before > 0.0) EXPECT_NEAR(std::log2(before / error), 5.0, 0.15);
    before = error;
  }
}

TEST(VelocityVerlet, IsSymplectic) {
  const Chain chain(4);
  const Eigen::Index n = 15;
  const std::vector<double>& mass = chain.system->scene().rods[0].mass;
  const auto step = [&](const Eigen::VectorXd& from) {
    State state = chain.state;
    state.y.head(2 * n) = from;
    VelocityVerlet stepper(*chain.system);
    if (!stepper.advance(state, 2e-3).ok()) throw std::runtime_error("step failed");
    return Eigen::VectorXd(state.y.head(2 * n));
  };
  // Of the free masses, velocities turned into momenta.
  Eigen::MatrixXd jacobian(2 * n - 6, 2 * n - 6);
  const auto place = [&](Eigen::Index k) { return k < n - 3 ? k + 3 : k + 6; };
  const auto weight = [&](Eigen::Index k) {
    return k < n - 3 ? 1.0 : mass[static_cast<std::size_t>((place(k) - n) / 3)];
  };
  for (Eigen::Index c = 0; c < 2 * n - 6; ++c) {
    Eigen::VectorXd up = chain.state.y.head(2 * n);
    Eigen::VectorXd down = up;
    const double d = c < n - 3 ? 1e-6 : 1e-3;
    up[place(c)] += d;
    down[place(c)] -= d;
    const Eigen::VectorXd column = (step(up) - step(down)) / (2 * d * weight(c));
    for (Eigen::Index r = 0; r < 2 * n - 6; ++r) jacobian(r, c) = column[place(r)] * weight(r);
  }
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(2 * n - 6, 2 * n - 6);
  form.topRightCorner(n - 3, n - 3).setIdentity();
  form.bottomLeftCorner(n - 3, n - 3) = -Eigen::MatrixXd::Identity(n - 3, n - 3);
  EXPECT_GT((jacobian - Eigen::MatrixXd::Identity(2 * n - 6, 2 * n - 6)).norm(), 0.1);
  EXPECT_LT((jacobian.transpose() * form * jacobian - form).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(VelocityVerlet, RunsBackTheWayItCame) {
  const Chain chain(16);
  State state = chain.state;
  VelocityVerlet stepper(*chain.system);
  const auto turn_back = [&] { state.y.segment(51, 51) *= -1; };
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(stepper.advance(state, 1e-3).ok());
  EXPECT_GT((state.y.head(51) - chain.state.y.head(51)).cwiseAbs().maxCoeff(), 0.1);
  turn_back();
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(stepper.advance(state, 1e-3).ok());
  turn_back();
  EXPECT_LT((state.y.head(102) - chain.state.y.head(102)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(VelocityVerlet, UndoesTheWayOfADirector) {
  // No springs, next to no inertia of the spin: nothing but the drift.
  Scene scene;
  const std::vector<Vec3> p = test::straight(3, 3.0);
  scene.rods.push_back(
      make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), SpringConstants{0, 0, 0, 0, 0, 1.0, 1e-30}));
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  Random random(5);
  const State start = test::stirred(system, random, 0.4);
  State state = start;
  VelocityVerlet stepper(system);
  double turned = 0.0;
  for (const double sign : {1.0, -1.0}) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(stepper.advance(state, 0.5).ok()) << sign;
    for (std::size_t i = 0; i < 4; ++i)
      turned = std::max(turned, (state.director[i] - start.director[i]).norm());
    state.y.segment(12, 12) *= -1;
    state.y.segment(28, 4) *= -1;
    stepper.restart();
  }
  EXPECT_GT(turned, 0.3);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((state.director[i] - start.director[i]).norm(), 1e-14) << i;
}

/// Everything that makes forces depend on velocity or time: viscosity, drag, a moved anchor, a joint.
System busy_plant() {
  Scene scene;
  scene.rods.push_back(test::straight_rod(6, 1e5, 0.02));
  scene.rods[0].viscosity = 1e-3;
  scene.rods[0].mass_damping = 0.5;
  std::vector<Vec3> leaf;
  for (int i = 0; i < 4; ++i) leaf.emplace_back(0.5, 0.15 * i, 0.02 * i * i);
  scene.rods.push_back(make_rod(leaf, orientation_towards(leaf, Vec3::UnitZ(), 0.1), {1e5, 4e4, 800},
                                elliptic_section(0.03, 0.01)));
  scene.joints.push_back({0, 3, 1});
  Anchor hand{0, 0, true, true, {}};
  hand.motion = [](double t) {
    AnchorPose pose;
    pose.frame = {-Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
    pose.position = Vec3(0, 0, 0.05 * std::sin(8 * t));
    pose.velocity = Vec3(0, 0, 0.4 * std::cos(8 * t));
    return pose;
  };
  scene.anchors.push_back(hand);
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  WindOptions wind;
  wind.mean = Vec3(0, 4, 0);
  scene.forces.push_back(std::make_shared<Wind>(wind));
  return System(scene);
}

class EveryFixedStepperOnAPlant : public testing::TestWithParam<Order> {};

TEST_P(EveryFixedStepperOnAPlant, HasItsOrder) {
  const auto [method, order, steps] = GetParam();
  const System system = busy_plant();
  const auto end = [&](Method by, int count) {
    State state = system.rest_state();
    const auto stepper = make_stepper(by, system);
    for (int i = 0; i < count; ++i)
      if (!stepper->advance(state, 0.5 / count).ok()) throw std::runtime_error("step failed");
    return Eigen::VectorXd(state.y);
  };
  const Eigen::VectorXd reference = end(Method::cash_karp, 6400);
  double before = 0.0;
  for (const int n : {steps, 2 * steps, 4 * steps}) {
    // With the work coordinate.
    const double error = (end(method, n) - reference).norm();
    const double found = std::log2(before / error);
    std::printf("%s on the plant, %d steps: error %.2e, order %.2f\n", to_string(method), n, error, found);
    if (before > 0.0) EXPECT_NEAR(found, order, 0.15);
    before = error;
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, EveryFixedStepperOnAPlant,
                         testing::Values(Order{Method::explicit_euler, 1, 8000},
                                         Order{Method::backward_euler, 1, 3200},
                                         Order{Method::runge_kutta4, 4, 800}, Order{Method::verlet, 2, 400}),
                         [](const auto& one) { return std::string(to_string(one.param.method)); });

TEST(VelocityVerlet, EvaluatesTwiceAStepOnlyWhereVelocitiesMatter) {
  const auto evaluations = [](const Scene& scene) {
    const System system(scene);
    State state = system.rest_state();
    VelocityVerlet stepper(system);
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(stepper.advance(state, 1e-3).ok());
    return stepper.evaluations();
  };
  const Scene plain = Oscillators::scene();
  EXPECT_EQ(evaluations(plain), 11);
  Scene damped = plain;
  damped.rods[0].mass_damping = 0.1;
  EXPECT_EQ(evaluations(damped), 21);
  Scene viscous = plain;
  viscous.rods[0].viscosity = 0.1;
  EXPECT_EQ(evaluations(viscous), 21);
  Scene spinning = plain;
  spinning.twist = Scene::Twist::everywhere;
  EXPECT_EQ(evaluations(spinning), 21);
  Scene blown = plain;
  blown.forces.push_back(std::make_shared<Wind>(WindOptions{}));
  EXPECT_EQ(evaluations(blown), 21);
}

}  // namespace
}  // namespace tendril
