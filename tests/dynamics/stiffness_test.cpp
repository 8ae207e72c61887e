#include <gtest/gtest.h>
#include <tendril/base/error.h>
#include <tendril/dynamics/stiffness.h>

#include "support/statics.h"

namespace tendril {
namespace {

using test::Keep;
using test::Random;

/// Largest difference between the exact Hessian and central differences of order 4 of the exact gradient,
/// relative to the Hessian's largest entry, over the free coordinates.
double hessian_error(const System& system, const State& state, double h) {
  const auto work = system.make_workspace();
  Eigen::SparseMatrix<double> sparse;
  if (!elastic_stiffness(system, state, sparse, *work).ok()) return HUGE_VAL;
  const Eigen::MatrixXd exact(sparse);
  const test::FreeCoordinates free(system);
  double worst = (exact - exact.transpose()).cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < free.y.size(); ++k) {
    const auto gradient_at = [&](double by) {
      Eigen::VectorXd y = state.y;
      y[free.y[k]] += by;
      return test::coordinate_gradient(system, free, state, y);
    };
    const Eigen::VectorXd difference =
        (8 * (gradient_at(h) - gradient_at(-h)) - (gradient_at(2 * h) - gradient_at(-2 * h))) / (12 * h);
    worst = std::max(worst, (difference - exact.col(free.gradient[k])(free.gradient)).cwiseAbs().maxCoeff());
  }
  return worst / exact.cwiseAbs().maxCoeff();
}

/// Of two steps the better: where an edge is close to its rest cone's tip the third spring changes over a
/// short way.
double hessian_error(const System& system, const State& state) {
  return std::min(hessian_error(system, state, 1e-3), hessian_error(system, state, 1e-4));
}

class EverySpring : public testing::TestWithParam<Keep> {};
INSTANTIATE_TEST_SUITE_P(Springs, EverySpring,
                         testing::Values(Keep::all, Keep::stretch, Keep::bend_l, Keep::bend_m, Keep::bend_t,
                                         Keep::twist));

TEST_P(EverySpring, HasTheExactHessian) {
  Random random(41);
  for (int trial = 0; trial < 6; ++trial) {
    Scene scene;
    scene.rods.push_back(test::uneven_rod(random, 8));
    test::keep(scene.rods[0], GetParam());
    scene.twist = Scene::Twist::everywhere;
    if (trial % 2) scene.anchors = {{0, 0, true, true, {}}, {0, 4, false, true, {}}};
    const System system(scene);
    EXPECT_LT(hessian_error(system, test::stirred(system, random, 0.2)), 1e-8) << trial;
  }
}

/// A stem with two branches, one of them off the stem's own root, and a twig on the root of the other.
Scene small_tree(Random& random) {
  Scene scene;
  scene.rods.push_back(test::uneven_rod(random, 6));
  const auto branch = [&](std::size_t parent, std::size_t node) {
    Rod rod = test::uneven_rod(random, 4);
    const Vec3 shift = scene.rods[parent].p[node] - rod.p[0];
    for (std::size_t i = 0; i < rod.p.size(); ++i) {
      rod.p[i] += shift;
      rod.q[i] += shift;
    }
    scene.joints.push_back({parent, node, scene.rods.size()});
    scene.rods.push_back(std::move(rod));
  };
  branch(0, 3);
  branch(0, 0);
  branch(1, 0);
  branch(1, 1);
  return scene;
}

TEST(Stiffness, IsExactAcrossJoints) {
  Random random(43);
  for (int trial = 0; trial < 6; ++trial) {
    Scene scene = small_tree(random);
    if (trial % 2) scene.anchors = {{0, 0, true, true, {}}};
    const System system(scene);
    EXPECT_LT(hessian_error(system, test::stirred(system, random, 0.1)), 1e-8) << trial;
  }
}

TEST(Stiffness, IsExactWithoutTwistState) {
  Random random(42);
  Scene scene;
  scene.rods.push_back(test::straight_rod(9, 1e4, 0.05));
  scene.anchors.push_back({0, 0, true, true, {}});
  const System system(scene);
  ASSERT_EQ(system.twist_count(), 0u);
  EXPECT_LT(hessian_error(system, system.rest_state()), 1e-8);
  for (int trial = 0; trial < 6; ++trial)
    EXPECT_LT(hessian_error(system, test::stirred(system, random, 0.02)), 1e-8) << trial;
}

void expect_exact(int edges, Scene::Twist twist, Random& random) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(edges, 1e4, 0.2 / edges));
  scene.rods.push_back(test::straight_rod(edges % 5 + 1, 1e4, 0.05));
  if (edges > 1) scene.anchors.push_back({0, 0, true, true, {}});
  scene.twist = twist;
  const System system(scene);
  ASSERT_EQ(system.twist_count() > 0, twist == Scene::Twist::everywhere);
  for (const double by : {0.01, 0.3})
    EXPECT_LT(hessian_error(system, test::stirred(system, random, by / edges), 1e-3 / edges), 1e-8)
        << edges << " edges, stirred by " << by;
}

/// Nodes are taken four at a time, and so many without twist at once: rods of every number, so that the ends
/// of all these fall everywhere. Stirred a little, all angles are small; stirred more, some are not.
TEST(Stiffness, IsExactForRodsOfAnyNumberOfEdges) {
  Random random(43);
  for (int edges = 1; edges < 8; ++edges) expect_exact(edges, Scene::Twist::everywhere, random);
  for (const int edges : {1, 2, 3, 4, 5, 6, 7, 31, 32, 34})
    expect_exact(edges, Scene::Twist::where_needed, random);
}

}  // namespace
}  // namespace tendril
