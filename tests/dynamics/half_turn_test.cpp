#include <gtest/gtest.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/stiffness.h>

#include "support/equilibria.h"
#include "support/numbers.h"
#include "support/statics.h"

// Bending is the same with a twist state and without, and its angles are true up to half a turn.
namespace tendril {
namespace {

using tendril::test::kPi;
const Vec3 kDown(0, -9.81, 0);

Vec3 place(const State& state, Eigen::Index node) {
  return state.y.segment<3>(3 * node);
}

/// An upright strip, clamped at its foot, that its own weight bends over: q L^3 / E I = 500.
Equilibrium bent_over(int edges) {
  std::vector<Vec3> p;
  for (int i = 0; i <= edges; ++i) p.push_back(i / static_cast<double>(edges) * Vec3(0.02, 1, 0));
  Scene scene;
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.01),
                                {2354400, 2354400 / 2.8, 1000}, rectangular_section(0.01, 0.02)));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(kDown));
  return test::balanced(System(scene));
}

TEST(Strip, DoesNotFoldThroughItsClamp) {
  const Equilibrium fine = bent_over(64);
  EXPECT_NEAR(fine.elastic, 0.17, 0.001);
  double before = 0.0;
  for (const int edges : {16, 32}) {
    const Equilibrium found = bent_over(edges);
    EXPECT_EQ(found.stability.kind, Stability::Kind::stable);
    const double off = found.elastic / fine.elastic - 1;
    std::printf("strip of %d edges: elastic energy %.5f, %.4f off\n", edges, found.elastic, off);
    EXPECT_LT(std::abs(off), edges == 16 ? 0.13 : 0.01);
    if (edges == 32) EXPECT_LT(std::abs(off), std::abs(before) / 3);
    before = off;
    const Vec3 first = place(found.state, 1) - place(found.state, 0);
    EXPECT_GT(first.y(), 0.0);
  }
}

/// A round rod clamped in its middle, with or without a twist state.
Scene clamped_rod(Scene::Twist twist) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(10, 1e6, 0.02));
  scene.anchors.push_back({0, 5, true, true, {}});
  scene.twist = twist;
  return scene;
}

/// A rod whose edges leave the clamp at large angles and go on bending.
State bent(const System& system, test::Random& random) {
  State state = system.rest_state();
  const auto direction = [&](double angle, double about) {
    return Vec3(std::cos(angle), std::sin(angle) * std::cos(about), std::sin(angle) * std::sin(about));
  };
  for (const Eigen::Index way : {1, -1}) {
    double angle = random.uniform(1.7, 2.9);
    double about = random.uniform(-kPi, kPi);
    for (Eigen::Index i = 1; i <= 5; ++i) {
      const Eigen::Index node = 5 + way * i;
      const Vec3 d = way * direction(angle, about);
      state.y.segment<3>(3 * node) = place(state, node - way) + 0.1 * random.uniform(0.95, 1.05) * d;
      angle += random.uniform(-1.2, 1.2);
      about += random.uniform(-0.3, 0.3);
    }
  }
  return state;
}

/// Directors carried along from the clamp: the rod is not twisted.
void untwist(State& state) {
  const System round(clamped_rod(Scene::Twist::where_needed));
  const auto work = round.make_workspace();
  State plain = round.rest_state();
  plain.y.head(33) = state.y.head(33);
  const std::vector<Frame> frames = round.frames(plain, *work);
  for (std::size_t i = 0; i < 11; ++i) {
    state.tangent[i] = frames.at(i).z;
    state.director[i] = frames.at(i).y;
  }
}

TEST(Bending, IsTheSameWithATwistStateAndWithout) {
  const System with(clamped_rod(Scene::Twist::everywhere)), without(clamped_rod(Scene::Twist::where_needed));
  ASSERT_EQ(without.twist_count(), 0u);
  test::Random random(5);
  const auto one = with.make_workspace(), other = without.make_workspace();
  for (int pose = 0; pose < 50; ++pose) {
    const State plain = bent(without, random);
    State twisted = with.rest_state();
    twisted.y.head(33) = plain.y.head(33);
    untwist(twisted);
    double energy[2];
    Eigen::VectorXd gradient[2];
    ASSERT_TRUE(with.elastic_gradient(twisted, 0.0, twisted.y, energy[0], gradient[0], *one).ok());
    ASSERT_TRUE(without.elastic_gradient(plain, 0.0, plain.y, energy[1], gradient[1], *other).ok());
    EXPECT_NEAR(energy[0], energy[1], 1e-13 * energy[1]) << pose;
    const double scale = gradient[1].cwiseAbs().maxCoeff();
    EXPECT_LT((gradient[0].head(33) - gradient[1]).cwiseAbs().maxCoeff(), 1e-11 * scale) << pose;
    // Nothing turns a round rod about itself, but for what rounding makes of its stiff springs.
    EXPECT_LT(gradient[0].tail(11).cwiseAbs().maxCoeff(), 1e-12 * energy[1]) << pose;
  }
}

/// First and second derivatives where edges stand at any angle up to half a turn from a held frame.
TEST(Bending, HasItsDerivativesAtLargeAngles) {
  test::Random random(6);
  Scene scene = clamped_rod(Scene::Twist::everywhere);
  Rod& rod = scene.rods[0];
  for (double& k : rod.bend_m) k *= 3.0;
  for (double& k : rod.bend_t) k = 0.5 * rod.bend_l[0];
  for (double& k : rod.stretch) k = 5 * rod.bend_l[0];
  const System system(scene);
  const auto work = system.make_workspace();
  const test::FreeCoordinates free(system);
  for (int pose = 0; pose < 8; ++pose) {
    State state = bent(system, random);
    untwist(state);
    ASSERT_TRUE(system.rebase(state, *work).ok());
    double energy = 0.0;
    Eigen::VectorXd gradient, unused;
    ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, gradient, *work).ok());
    Eigen::SparseMatrix<double> sparse;
    ASSERT_TRUE(elastic_stiffness(system, state, sparse, *work).ok());
    const Eigen::MatrixXd exact(sparse);
    double worst[2] = {};
    for (std::size_t k = 0; k < free.y.size(); ++k) {
      const auto at = [&](double by) {
        Eigen::VectorXd y = state.y;
        y[free.y[k]] += by;
        return y;
      };
      const auto energy_at = [&](double by) {
        double value = 0.0;
        EXPECT_TRUE(system.elastic_gradient(state, 0.0, at(by), value, unused, *work).ok());
        return value;
      };
      const auto slope_at = [&](double by) { return test::coordinate_gradient(system, free, state, at(by)); };
      const double h = 1e-4;
      const double slope =
          (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) / (12 * h);
      worst[0] = std::max(worst[0], std::abs(slope - gradient[free.gradient[k]]));
      const Eigen::VectorXd column =
          (8 * (slope_at(h) - slope_at(-h)) - (slope_at(2 * h) - slope_at(-2 * h))) / (12 * h);
      worst[1] =
          std::max(worst[1], (column - exact.col(free.gradient[k])(free.gradient)).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(worst[0], 1e-8 * gradient.cwiseAbs().maxCoeff()) << pose;
    EXPECT_LT(worst[1], 1e-7 * exact.cwiseAbs().maxCoeff()) << pose;
  }
}

/// Half a turn at a held frame is refused by name, and so is the way through it.
TEST(HalfTurn, IsAsFarAsBendingGoes) {
  for (const auto twist : {Scene::Twist::everywhere, Scene::Twist::where_needed}) {
    Scene scene = clamped_rod(twist);
    scene.anchors[0].node = 0;
    const System system(scene);
    const auto work = system.make_workspace();
    const auto turned = [&](double angle) {
      State state = system.rest_state();
      for (Eigen::Index i = 1; i <= 10; ++i)
        state.y.segment<3>(3 * i) = 0.1 * static_cast<double>(i) * Vec3(std::cos(angle), 0, std::sin(angle));
      return state;
    };
    State state = system.rest_state();
    for (double angle = 0.1; angle < 3.1; angle += 0.1) {
      const State to = turned(angle);
      state.y.head(33) = to.y.head(33);
      ASSERT_TRUE(system.rebase(state, *work).ok());
      double energy = 0.0;
      Eigen::VectorXd gradient;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, gradient, *work).ok()) << angle;
      EXPECT_NEAR(energy, 0.5 * scene.rods[0].bend_l[0] * angle * angle, 1e-9) << angle;
    }
    for (const double angle : {kPi, kPi + 0.05}) {
      Eigen::VectorXd rate, there = state.y;
      there.head(33) = turned(angle).y.head(33);
      const Evaluation at = system.derivative(state, 0.0, there, rate, *work);
      EXPECT_EQ(at.outcome, Evaluation::Outcome::fold_back) << angle;
      EXPECT_EQ(at.node, 0u);
    }
  }
}

/// What cannot be seen changes nothing: viscosity of 1e-12.
TEST(Viscosity, OfNextToNothingMovesNothing) {
  std::vector<Eigen::VectorXd> end;
  for (const double viscosity : {0.0, 1e-12}) {
    Scene scene;
    scene.rods.push_back(make_rod(test::straight(16, 1.0),
                                  orientation_towards(test::straight(16, 1.0), Vec3::UnitZ(), 0.1),
                                  {2e5, 2e5 / 2.6, 1200}, circular_section(0.02)));
    scene.rods[0].viscosity = viscosity;
    scene.anchors.push_back({0, 0, true, true, {}});
    scene.forces.push_back(std::make_shared<Gravity>(kDown));
    const System system(scene);
    SimulationOptions options;
    options.method = Method::automatic;
    options.tolerance = 1e-7;
    Simulation simulation(system, system.rest_state(), options);
    ASSERT_EQ(simulation.run(0.9).stop, Stop::finished);
    end.push_back(simulation.state().y.head(51));
  }
  EXPECT_LT((end[0] - end[1]).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace tendril
