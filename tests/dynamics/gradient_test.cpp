#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>

#include <cstdint>
#include <set>
#include <vector>

#include "support/rods.h"

namespace tendril {
namespace {

using test::Keep;
using test::keep;
using test::Random;

/// Largest difference between the exact gradient and central differences of order 4 with step h, relative to
/// the largest entry.
double gradient_error(const System& system, const State& state, double h) {
  const auto work = system.make_workspace();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  double energy = 0.0;
  Eigen::VectorXd gradient;
  Eigen::VectorXd unused;
  if (!system.elastic_gradient(state, 0.0, state.y, energy, gradient, *work).ok()) return HUGE_VAL;
  const auto energy_at = [&](Eigen::Index place, double by) {
    Eigen::VectorXd y = state.y;
    y[place] += by;
    double value = 0.0;
    return system.elastic_gradient(state, 0.0, y, value, unused, *work).ok() ? value : HUGE_VAL;
  };
  double worst = 0.0;
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const Eigen::Index place = k < 3 * n ? k : 3 * n + k;
    const double difference = (8 * (energy_at(place, h) - energy_at(place, -h)) -
                               (energy_at(place, 2 * h) - energy_at(place, -2 * h))) /
                              (12 * h);
    worst = std::max(worst, std::abs(difference - gradient[k]));
  }
  return worst / gradient.cwiseAbs().maxCoeff();
}

/// Of the steps that balance truncation against rounding, the better: near a fold the energy changes over the
/// gap.
double gradient_error(const System& system, const State& state) {
  return std::min(gradient_error(system, state, 2e-4), gradient_error(system, state, 4e-5));
}

class EveryEnergy : public testing::TestWithParam<Keep> {};
INSTANTIATE_TEST_SUITE_P(Energies, EveryEnergy,
                         testing::Values(Keep::all, Keep::stretch, Keep::bend_l, Keep::bend_m, Keep::bend_t,
                                         Keep::twist));

TEST_P(EveryEnergy, GradientMatchesDifferencesInStirredStates) {
  Random random(17);
  for (int trial = 0; trial < 20; ++trial) {
    Scene scene;
    scene.rods.push_back(test::uneven_rod(random, 9));
    scene.twist = Scene::Twist::everywhere;
    keep(scene.rods[0], GetParam());
    const System system(scene);
    EXPECT_LT(gradient_error(system, test::stirred(system, random, 0.25)), 1e-8) << "trial " << trial;
  }
}

// Forces of small angles come from series, energies and their gradient from angles.
TEST(Forces, AreTheGradientWhetherAnglesAreSmallOrNot) {
  Random random(19);
  for (const auto twist : {Scene::Twist::everywhere, Scene::Twist::where_needed})
    for (const double by : {1e-9, 1e-4, 1e-2, 0.05, 0.1, 0.2, 0.3}) {
      Scene scene;
      scene.rods.push_back(test::straight_rod(300, 1e6, 0.3));
      for (Vec3& p : scene.rods[0].p) p *= 300.0;
      for (Vec3& q : scene.rods[0].q) q.x() *= 300.0;
      if (twist == Scene::Twist::everywhere) scene.rods[0].bend_t = scene.rods[0].bend_l;
      scene.twist = twist;
      const System system(scene);
      const State state = test::stirred(system, random, by);
      const auto work = system.make_workspace();
      double energy = 0.0;
      Eigen::VectorXd gradient;
      Eigen::VectorXd rate;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, gradient, *work).ok());
      State still = state;
      const auto n = static_cast<Eigen::Index>(system.node_count());
      still.y.tail(still.y.size() - 3 * n).setZero();
      ASSERT_TRUE(system.derivative(still, 0.0, still.y, rate, *work).ok());
      double worst = 0.0;
      for (Eigen::Index k = 0; k < 3 * n; ++k)
        worst = std::max(
            worst,
            std::abs(scene.rods[0].mass[static_cast<std::size_t>(k / 3)] * rate[3 * n + k] + gradient[k]));
      EXPECT_LT(worst, 1e-14 * gradient.head(3 * n).cwiseAbs().maxCoeff()) << "stirred by " << by;
    }
}

// A vector loop must not begin where an address suits it: its first and last numbers round differently.
TEST(Forces, DoNotDependOnWhereNumbersLie) {
  Random random(20);
  Scene scene;
  for (const int edges : {36, 29}) scene.rods.push_back(test::straight_rod(edges, 1e6, 0.3));
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  const State state = test::stirred(system, random, 1e-4);
  std::vector<std::vector<char>> between;  // shifts what is allocated next
  std::set<std::uintptr_t> places;
  std::vector<Eigen::VectorXd> states, rates;
  for (std::size_t shift = 0; shift < 24; ++shift) {
    between.emplace_back(16 * shift + 1);
    const auto work = system.make_workspace();
    const Eigen::VectorXd& y = states.emplace_back(state.y);
    Eigen::VectorXd rate;
    ASSERT_TRUE(system.derivative(state, 0.0, y, rate, *work).ok());
    places.insert(reinterpret_cast<std::uintptr_t>(y.data()) % 64);
    rates.push_back(std::move(rate));
    EXPECT_EQ(rates.back(), rates.front()) << "y at " << y.data();
  }
#ifndef __SANITIZE_ADDRESS__  // whose allocator has one place for all
  EXPECT_GT(places.size(), 1u);
#endif
}

TEST_P(EveryEnergy, GradientMatchesDifferencesWithHeldFrames) {
  Random random(18);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 9));
  keep(scene.rods[0], GetParam());
  scene.twist = Scene::Twist::everywhere;
  const System free_system(scene);
  for (const std::size_t node : {0u, 4u, 8u}) {
    // Held frame, free position: the gradient with respect to the position is still exact.
    scene.anchors.push_back({0, node, false, true, {}});
    const System system(scene);
    State state = test::stirred(system, random, 0.2);
    const auto work = system.make_workspace();
    double energy = 0.0;
    Eigen::VectorXd gradient;
    ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, gradient, *work).ok());
    const auto n = static_cast<Eigen::Index>(system.node_count());
    for (Eigen::Index k = 0; k < 3 * n; ++k) {
      Eigen::VectorXd y = state.y;
      Eigen::VectorXd unused;
      double up = 0.0;
      double down = 0.0;
      y[k] += 1e-5;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, y, up, unused, *work).ok());
      y[k] -= 2e-5;
      ASSERT_TRUE(system.elastic_gradient(state, 0.0, y, down, unused, *work).ok());
      EXPECT_NEAR((up - down) / 2e-5, gradient[k], 2e-8 * std::max(1.0, gradient.cwiseAbs().maxCoeff())) << k;
    }
  }
}

TEST(Gradient, MatchesDifferencesNearlyFolded) {
  Random random(5);
  for (const double gap : {0.5, 0.1, 0.03}) {
    Scene scene;
    scene.rods.push_back(test::uneven_rod(random, 5));
    scene.twist = Scene::Twist::everywhere;
    const System system(scene);
    State state = system.rest_state();
    const auto work = system.make_workspace();
    // Fold the third edge back onto the second, up to a gap, in steps that the carried frames can follow.
    for (int step = 1; step <= 20; ++step) {
      const double angle = (std::numbers::pi - gap) * step / 20;
      const Vec3 p1 = test::at(state.y, 1);
      const Vec3 p2 = test::at(state.y, 2);
      const Vec3 e = (p2 - p1).normalized();
      const Vec3 n = e.cross(Vec3(0.3, -0.5, 0.8)).normalized();
      state.y.segment<3>(9) = p2 + rotate_about(n, angle, e) * 1.1;
      state.y.segment<3>(12) = p2 + rotate_about(n, angle, e) * 1.1 + rotate_about(n, angle, n.cross(e));
      ASSERT_TRUE(system.rebase(state, *work).ok());
    }
    EXPECT_LT(gradient_error(system, state), 1e-8) << gap;
  }
}

TEST(Gradient, OfTheRodWithoutTwistState) {
  Random random(31);
  Scene scene;
  scene.rods.push_back(test::straight_rod(8, 1e4, 0.05));
  scene.rods[0].bend_t.assign(9, 0.3);
  const System system(scene);
  ASSERT_EQ(system.twist_count(), 0u);
  for (int trial = 0; trial < 20; ++trial)
    EXPECT_LT(gradient_error(system, test::stirred(system, random, 0.03)), 1e-8);
}

TEST(Gradient, OfForcesWithAnEnergy) {
  Random random(23);
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 6));
  const System system(scene);
  const State state = test::stirred(system, random, 0.2);
  std::vector<Vec3> p;
  for (std::size_t i = 0; i < 6; ++i) p.push_back(test::at(state.y, i));
  const std::vector<Vec3> zero(6, Vec3::Zero());
  const std::vector<double> numbers(6, 1.0);
  const std::vector<double>& mass = scene.rods[0].mass;
  const auto view = [&](const std::vector<Vec3>& at) {
    return StateView{0.7, at, zero, zero, numbers, mass, numbers, system.rods()};
  };
  const std::vector<std::shared_ptr<const Force>> forces{
      std::make_shared<Gravity>(Vec3(1, -2, -9.81)),
      std::make_shared<PointLoad>(PointLoad::Kind::force, 0, 3, Vec3(1, 2, 3), Signal::constant(-1.5)),
      std::make_shared<PullTowards>(0, 4, Vec3(3, 3, 1), 7.0)};
  for (const auto& force : forces) {
    ASSERT_TRUE(force->has_energy());
    std::vector<Vec3> f = zero;
    std::vector<Vec3> torque = zero;
    force->add(view(p), {f, torque});
    double largest = 0.0;
    for (const Vec3& v : f) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    EXPECT_GT(largest, 0.0);
    for (std::size_t i = 0; i < 6; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const double h = 1e-4;
        std::vector<Vec3> up = p;
        std::vector<Vec3> down = p;
        up[i][axis] += h;
        down[i][axis] -= h;
        EXPECT_NEAR(-(force->energy(view(up)) - force->energy(view(down))) / (2 * h), f[i][axis],
                    1e-8 * largest);
      }
  }
}

TEST(InternalForces, HaveNoResultantForceOrTorque) {
  Random random(77);
  for (int trial = 0; trial < 50; ++trial) {
    Scene scene;
    scene.rods.push_back(test::uneven_rod(random, 12));
    scene.twist = Scene::Twist::everywhere;
    const System system(scene);
    const State state = test::stirred(system, random, 0.3);
    const auto work = system.make_workspace();
    double energy = 0.0;
    Eigen::VectorXd g;
    ASSERT_TRUE(system.elastic_gradient(state, 0.0, state.y, energy, g, *work).ok());
    const std::vector<Frame> frames = system.frames(state, *work);
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    double largest = 0.0;
    for (std::size_t i = 0; i < 12; ++i) {
      const Vec3 f = -test::at(g, i);
      force += f;
      torque += test::at(state.y, i).cross(f) - g[36 + static_cast<Eigen::Index>(i)] * frames[i].z;
      largest = std::max(largest, f.norm());
    }
    const double reach = test::at(state.y, 11).norm();
    EXPECT_LT(force.norm() / largest, 1e-13);
    EXPECT_LT(torque.norm() / (largest * reach), 1e-13);
  }
}

}  // namespace
}  // namespace tendril
