#include <gtest/gtest.h>

#include "dynamics/scene/model.h"
#include "dynamics/steppers/stiff_solver.h"
#include "support/ties.h"

namespace tendril {
namespace {

/// What solves (s - J) U = r, put back with J U by central differences of the equations, over the size of
/// J U.
double residual(const System& system, double s) {
  const Model& model = model_of(system);
  test::Random random(5);
  State state = test::stirred(system, random, 0.02);
  const Eigen::Index k = model.bodies_span();
  for (Eigen::Index i = 0; i < model.v_begin(); ++i) state.y[model.v_begin() + i] = random.uniform(-1, 1);
  for (Eigen::Index i = 0; i < 2 * k; ++i) state.y[model.x_begin() + 2 * k + i] = random.uniform(-3, 3);
  const auto work = system.make_workspace();
  Eigen::VectorXd rate, up, down, r(state.y.size()), u;
  if (!system.rebase(state, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) return 1.0;
  const auto solver = make_stiff_solver(system, *work);
  if (solver->differentiate(state, rate) < 0 || !solver->factor(s)) return 1.0;
  for (double& x : r) x = random.uniform(-1, 1);
  solver->solve(s, r, u);
  const double h = 1e-6 / u.cwiseAbs().maxCoeff();
  if (!system.derivative(state, state.time, state.y + h * u, up, *work).ok()) return 1.0;
  if (!system.derivative(state, state.time, state.y - h * u, down, *work).ok()) return 1.0;
  const Eigen::VectorXd turned = (up - down) / (2 * h);
  // The bodies alone, whose rates are small beside those of the rods.
  const auto bodies = [&](const Eigen::VectorXd& y) { return y.segment(model.x_begin(), 4 * k); };
  const double on_all = (s * u - turned - r).head(u.size() - 1).cwiseAbs().maxCoeff() /
                        turned.head(u.size() - 1).cwiseAbs().maxCoeff();
  return std::max(on_all,
                  bodies(s * u - turned - r).cwiseAbs().maxCoeff() / bodies(turned).cwiseAbs().maxCoeff());
}

TEST(BodyBlocks, AreTheExactJacobian) {
  for (const bool derives : {true, false})
    for (const bool twist : {false, true})
      for (const double damping : {0.0, 0.7})
        for (const double s : {1.0, 100.0})
          EXPECT_LT(residual(System(test::tied(derives, 60.0, damping, twist)), s), 3e-5)
              << derives << twist << damping << ' ' << s;
}

TEST(BodyBlocks, AreTheExactJacobianOfFreeTops) {
  for (const bool twist : {false, true}) {
    Scene scene = test::tied(true, 1.0, 0.0, twist);
    scene.forces.clear();
    EXPECT_LT(residual(System(scene), 1.0), 3e-5);
    scene.rods.clear();
    EXPECT_LT(residual(System(scene), 1.0), 1e-7);
  }
}

}  // namespace
}  // namespace tendril
