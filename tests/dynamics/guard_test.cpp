#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/simulation.h>
#include <tendril/dynamics/stability.h>

#include <boost/numeric/odeint.hpp>
#include <limits>

#include "support/rods.h"

namespace tendril {
namespace {

TEST(CashKarpStability, AmplifiesUndampedOscillations) {
  // The sixth-order term, and the next one: y^6 / 7200 (1 + O(y^2)).
  for (const double y : {0.1, 0.2})
    EXPECT_NEAR((cash_karp_amplification(0, y) - 1) / (std::pow(y, 6) / 7200), 1.0, 0.04) << y;
  EXPECT_NEAR(cash_karp_amplification(0, 0.43), 1 + 1e-6, 1e-7);
  EXPECT_NEAR(cash_karp_amplification(-3.73, 0), 1.0, 0.02);
}

TEST(GuardStep, KeepsToItsLimits) {
  const GuardLimits only_step{1e-6, 1e9, 1.0};
  EXPECT_NEAR(guard_step(1e3, 0, 0, only_step) * 1e3, 0.44, 0.01);
  EXPECT_TRUE(std::isinf(guard_step(0, 1, 1, only_step)));
  EXPECT_EQ(guard_step(1e200, 0, 1, only_step), 0.0);
  EXPECT_EQ(guard_step(std::numeric_limits<double>::infinity(), 0, 0, only_step), 0.0);
  // Long runs share out the whole: y^5 T w / 7200 = limit.
  const GuardLimits whole{1e-6, 0.1, 60.0};
  const double y = guard_step(2e3, 0, 0, whole) * 2e3;
  EXPECT_NEAR(std::pow(y, 5) * 60.0 * 2e3 / 7200, 0.1, 0.01);
  // A viscous rod is limited by the real axis instead: h beta w^2 < 3.73 (and well above the undamped limit
  // below it).
  const double w = 1e4;
  EXPECT_NEAR(guard_step(w, 0, 1e-2, only_step) * 1e-2 * w * w, 3.7, 0.1);
  EXPECT_GT(guard_step(w, 0, 1e-4, only_step), 2 * guard_step(w, 0, 0, only_step));
}

TEST(LargestFrequency, IsThatOfTheStiffestMode) {
  // Axial: 2 / h sqrt(E / rho) for thick-spaced nodes; bending: 4 c (r / 2) / h^2 once the nodes are closer
  // than r.
  for (const auto& [edges, radius] : {std::pair{32, 5e-3}, std::pair{256, 2e-2}}) {
    Scene scene;
    scene.rods.push_back(test::straight_rod(edges, 1e6, radius));
    scene.anchors.push_back({0, 0, true, true, {}});
    const System system(scene);
    const double h = 1.0 / edges;
    const double c = std::sqrt(1e6 / 1000);
    const double axial = 2 * c / h;
    const double bending = 4 * c * (radius / 2) / (h * h);
    const auto work = system.make_workspace();
    const double found = system.largest_frequency(system.rest_state(), 16, *work);
    const double expected = std::max(axial, bending);
    EXPECT_GT(found, 0.95 * expected) << edges;
    EXPECT_LT(found, 1.25 * expected) << edges;
  }
}

/// The rods on which stock Cash-Karp steppers report success with errors of 0.3 to 0.7 of the length:
/// clamped, horizontal, let go under gravity with a little sideways motion and light drag, for one second.
struct Swing {
  int nodes;
  double young;
  long work_limit;
  bool finishes;  ///< else the guard must refuse: to refuse everything would not do
};
void PrintTo(const Swing& swing, std::ostream* out) {
  *out << swing.nodes << " nodes, E " << swing.young;
}

System swinging_rod(const Swing& swing) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(swing.nodes - 1, swing.young, 5e-3));
  scene.rods[0].mass_damping = 0.5;
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  return System(scene);
}

State let_go(const System& system) {
  State state = system.rest_state();
  const auto n = static_cast<Eigen::Index>(system.node_count());
  for (Eigen::Index i = 1; i < n; ++i)
    state.y[3 * n + 3 * i + 1] = 0.05 * static_cast<double>(i) / static_cast<double>(n);
  return state;
}

/// Another method and another code on the same equations: Dormand-Prince 5 of Boost.odeint at 1e-9.
Eigen::VectorXd reference(const System& system) {
  using Vector = std::vector<double>;
  namespace odeint = boost::numeric::odeint;
  const State start = let_go(system);
  const auto work = system.make_workspace();
  Vector y(start.y.data(), start.y.data() + start.y.size());
  Eigen::VectorXd dy;
  const auto rate = [&](const Vector& at, Vector& out, double t) {
    const Eigen::Map<const Eigen::VectorXd> view(at.data(), static_cast<Eigen::Index>(at.size()));
    if (!system.derivative(start, t, view, dy, *work).ok()) throw std::runtime_error("reference failed");
    std::copy(dy.data(), dy.data() + dy.size(), out.begin());
  };
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_dopri5<Vector>>(1e-9, 1e-9);
  odeint::integrate_adaptive(stepper, rate, y, 0.0, 1.0, 1e-6);
  return Eigen::Map<const Eigen::VectorXd>(y.data(), 3 * static_cast<Eigen::Index>(system.node_count()));
}

class EveryRod : public testing::TestWithParam<Swing> {};

TEST_P(EveryRod, EndsRightOrSaysWhyNot) {
  const System system = swinging_rod(GetParam());
  ASSERT_EQ(system.twist_count(), 0u);
  SimulationOptions options;
  options.method = Method::cash_karp;
  options.tolerance = 1e-3;
  options.work_limit = GetParam().work_limit;
  Simulation simulation(system, let_go(system), options);
  const Report report = simulation.run(1.0);
  std::printf("%d nodes, E %.0e: %s", GetParam().nodes, GetParam().young, to_string(report.stop));
  EXPECT_EQ(report.stop, GetParam().finishes ? Stop::finished : Stop::too_stiff) << report.reason;
  if (report.stop == Stop::finished) {
    const auto n = static_cast<Eigen::Index>(system.node_count());
    const double error =
        (simulation.state().y.head(3 * n) - reference(system)).norm() / std::sqrt(static_cast<double>(n));
    std::printf(", error %.1e of the length, %ld steps, %ld evaluations, energy %.1e\n", error,
                report.accepted, report.evaluations, report.imbalance);
    EXPECT_LT(error, 1e-2);
  } else {
    std::printf(": %s\n", report.reason.c_str());
    EXPECT_FALSE(report.reason.empty());
    EXPECT_TRUE(simulation.state().y.allFinite());
  }
}

#ifdef TENDRIL_LONG
INSTANTIATE_TEST_SUITE_P(Long, EveryRod,
                         testing::Values(Swing{32, 1e10, 20'000'000, true}, Swing{128, 1e6, 20'000'000, true},
                                         Swing{128, 1e8, 20'000'000, true},
                                         Swing{128, 1e10, 5'000'000, false},
                                         Swing{1024, 1e4, 5'000'000, true},
                                         Swing{1024, 1e6, 2'000'000, false},
                                         Swing{1024, 1e8, 2'000'000, false}));
#else
INSTANTIATE_TEST_SUITE_P(Short, EveryRod,
                         testing::Values(Swing{32, 1e4, 20'000'000, true}, Swing{32, 1e6, 20'000'000, true},
                                         Swing{32, 1e8, 20'000'000, true}, Swing{128, 1e4, 20'000'000, true},
                                         Swing{32, 1e10, 200'000, false}, Swing{128, 1e10, 200'000, false}));
#endif

}  // namespace
}  // namespace tendril
