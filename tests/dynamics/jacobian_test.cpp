#include <gtest/gtest.h>

#include "dynamics/steppers/stiff_solver.h"
#include "support/rods.h"

namespace tendril {
namespace {

/// What solves (s - J) U = r, put back with J U by differences of the equations, over the size of J U.
double residual(double viscosity, double s) {
  Scene scene;
  const std::vector<Vec3> p = test::straight(8, 1.0);
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3(0, 0.5, 1), 0.1), {1e5, 1e5 / 3, 1000},
                                elliptic_section(0.02, 0.012)));
  scene.rods[0].viscosity = viscosity;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.twist = Scene::Twist::everywhere;
  const System system(scene);
  test::Random random(5);
  State state = test::stirred(system, random, 0.02);
  const Eigen::Index v = 27, spin = 63;
  for (Eigen::Index i = 0; i < 27; ++i) state.y[v + i] = random.uniform(-1, 1);
  for (Eigen::Index i = 0; i < 9; ++i) state.y[spin + i] = random.uniform(-1, 1);
  const auto work = system.make_workspace();
  if (!system.rebase(state, *work).ok()) return 1.0;
  Eigen::VectorXd rate, up, down, r(state.y.size()), u;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) return 1.0;
  const auto solver = make_stiff_solver(system, *work);
  if (solver->differentiate(state, rate) < 0 || !solver->factor(s)) return 1.0;
  for (double& x : r) x = random.uniform(-1, 1);
  for (const Eigen::Index held : {0, 1, 2, 27, 28, 29, 54, 63, 72}) r[held] = 0.0;
  solver->solve(s, r, u);
  const double h = 1e-6 / u.cwiseAbs().maxCoeff();
  if (!system.derivative(state, state.time, state.y + h * u, up, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y - h * u, down, *work).ok()) return 1.0;
  const Eigen::VectorXd turned = (up - down) / (2 * h);
  return (s * u - turned - r).head(72).cwiseAbs().maxCoeff() / turned.head(72).cwiseAbs().maxCoeff();
}

TEST(StiffSolver, HasTheExactJacobian) {
  for (const double viscosity : {0.0, 1e-2, 1.0})
    for (const double s : {1.0, 100.0}) EXPECT_LT(residual(viscosity, s), 3e-5) << viscosity << ' ' << s;
}

TEST(StiffSolver, SaysWhereAndWhyItFails) {
  // The third node comes back on the first: opposite edges at node 1.
  Scene scene;
  scene.rods.push_back(test::straight_rod(4, 1e5, 0.02));
  const System system(scene);
  const auto work = system.make_workspace();
  State state = system.rest_state();
  Eigen::VectorXd rate;
  ASSERT_TRUE(system.derivative(state, 0.0, state.y, rate, *work).ok());
  const auto solver = make_stiff_solver(system, *work);
  ASSERT_GT(solver->differentiate(state, rate), 0);
  EXPECT_TRUE(solver->failure().ok());
  for (Eigen::Index k = 0; k < 3; ++k) state.y[6 + k] = state.y[k];
  EXPECT_LT(solver->differentiate(state, rate), 0);
  EXPECT_EQ(solver->failure().outcome, Evaluation::Outcome::fold_back);
  EXPECT_EQ(solver->failure().node, 1U);
}

}  // namespace
}  // namespace tendril
