#include <gtest/gtest.h>

#include <complex>

#include "support/equilibria.h"
#include "support/numbers.h"

// What counts as an equilibrium is balanced in every direction: what nothing resists is followed, or named.
namespace tendril {
namespace {

using tendril::test::kPi;
constexpr double kBalanced = 1e-9;

struct Hinged {
  int nodes;
  double young;
  Vec3 way;
};

Equilibrium hung(const Hinged& one) {
  std::vector<Vec3> p;
  for (int i = 0; i < one.nodes; ++i) p.push_back(i / (one.nodes - 1.0) * one.way.normalized());
  const Vec3 aside = one.way.cross(Vec3(0.1, 0.9, 0.3)).normalized();
  Scene scene;
  scene.rods.push_back(make_rod(p, orientation_towards(p, aside, 0.1), {one.young, one.young / 2.6, 1000},
                                circular_section(0.01)));
  scene.anchors.push_back({0, 0, true, false, {}});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -9.81)));
  const System system(scene);
  return find_equilibrium(system, system.rest_state());
}

/// Whichever way a rod points at first, and however stiff it is.
TEST(HingedRod, Hangs) {
  const double c = std::sqrt(0.5);
  double worst = 0.0;
  for (const int nodes : {2, 3, 5, 9, 17, 33, 65})
    for (const double young : {1e5, 1e8, 2e11})
      for (const Vec3& way : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(c, 0, c), Vec3(0, 0, 1), Vec3(0, 0, -1),
                              Vec3(0.6, 0.7, -0.3)}) {
        const Equilibrium found = hung({nodes, young, way});
        SCOPED_TRACE(testing::Message() << nodes << " nodes, E " << young << ", towards " << way.transpose());
        ASSERT_EQ(found.balance, Balance::converged) << found.reason;
        worst = std::max(worst, found.residual);
        EXPECT_LE(found.residual, kBalanced);
        EXPECT_EQ(found.stability.unstable, 0);
        const Vec3 end = test::tip(found);
        EXPECT_LT(std::hypot(end.x(), end.y()), 1e-6);
        EXPECT_LT(end.z(), -0.99);
      }
  std::printf("largest residual of 126 hinged rods %.1e\n", worst);
}

TEST(FreeRod, IsSaidToBeHeldByNothing) {
  Scene scene;
  scene.rods.push_back(test::straight_rod(8, 1e6, 0.01));
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, -9.81, 0)));
  const System falling(scene);
  const Equilibrium none = find_equilibrium(falling, falling.rest_state());
  EXPECT_EQ(none.balance, Balance::unheld);
  EXPECT_NE(none.reason.find("nothing holds rod 0"), std::string::npos) << none.reason;
  EXPECT_LT(none.factorisations, 1000);
  // Pulled at both ends it turns until the pulls are in line with it.
  scene.forces = {test::point_load(PointLoad::Kind::force, 8, Vec3(0, 0, 2e-2)),
                  test::point_load(PointLoad::Kind::force, 0, Vec3(0, 0, -2e-2))};
  const System pulled(scene);
  const Equilibrium found = test::balanced(pulled);
  EXPECT_LE(found.residual, kBalanced);
  const Vec3 along = test::at(found.state.y, 8) - test::at(found.state.y, 0);
  EXPECT_NEAR(along.normalized().z(), 1.0, 1e-9);
}

/// Deflection halfway of a shaft under opposite torques M about its axis at hinged ends and a weight q across
/// it: u'' - i M u' = q s (1 - s) / 2 in u = y + i z, for B = 1 and length 1.
double shaft_deflection(double torque, double weight) {
  using Complex = std::complex<double>;
  const Complex a(0, torque);
  // v = u' = c e^(a s) - q / 2 (s (1 - s) / a + (1 - 2 s) / a^2 - 2 / a^3), and u(0) = u(1) = 0.
  const auto particular = [&](double s) {
    return -weight / 2 * ((s * s / 2 - s * s * s / 3) / a + (s - s * s) / (a * a) - 2 * s / (a * a * a));
  };
  const auto homogeneous = [&](double s) { return (std::exp(a * s) - 1.0) / a; };
  const Complex c = -particular(1.0) / homogeneous(1.0);
  return std::abs(c * homogeneous(0.5) + particular(0.5));
}

/// Greenhill's shaft, which buckles at M L / B = 2 pi. Near it the tangent is soft, and its torques turn with
/// nothing: they have no energy.
TEST(Shaft, BendsAsTheBeamUnderTorqueDoesUpToGreenhillsLimit) {
  for (const double share : {0.5, 0.9, 0.97}) {
    const double torque = 2 * kPi * share, weight = 1e-4;
    const double exact = shaft_deflection(torque, weight);
    std::vector<double> error;
    for (const int edges : {64, 128, 256}) {
      Scene scene;
      scene.rods.push_back(test::unit_rod(edges, 1e-2));
      const double mass = test::total_mass(scene.rods[0]);
      scene.anchors = {{0, 0, true, false, {}}, {0, static_cast<std::size_t>(edges), true, false, {}}};
      scene.forces = {std::make_shared<Gravity>(Vec3(0, 0, -weight / mass)),
                      test::point_load(PointLoad::Kind::torque, edges, Vec3(torque, 0, 0)),
                      test::point_load(PointLoad::Kind::torque, 0, Vec3(-torque, 0, 0))};
      const Equilibrium found = test::balanced(System(scene));
      EXPECT_LE(found.residual, kBalanced);
      EXPECT_LT(found.factorisations, 60);
      EXPECT_EQ(found.stability.kind, Stability::Kind::not_judged);
      const Vec3 middle = test::at(found.state.y, static_cast<std::size_t>(edges / 2));
      error.push_back(std::hypot(middle.y(), middle.z()) / exact - 1);
    }
    std::printf("shaft at %.2f of its limit: %.4f %.4f %.4f, order %.2f\n", share, error[0], error[1],
                error[2], test::order(error[1], error[2]));
    // The discrete shaft's limit is off by as much as its deflection far below it; near it by that over what
    // is left.
    EXPECT_LT(std::abs(error[2]), 2e-4 / (1 - share));
    EXPECT_NEAR(test::order(error[1], error[2]), 2.0, 0.2);
  }
}

/// A chain that does not bend, from the shape of a V to the catenary: sag over the span of a chain twice as
/// long.
TEST(Chain, ComesFromAVToTheCatenary) {
  const double length = 2.0, sag = 0.7963883559, depth = std::sqrt(length * length / 4 - 0.25);
  for (const double tension : {7e7, 1e9}) {
    std::vector<double> error;
    for (const int edges : {32, 64, 128}) {
      Rod rod = test::round_rod(edges, length, 0.0, 0.0, tension);
      for (int i = 0; i <= edges; ++i) {
        const double s = static_cast<double>(i) / edges;
        rod.p[static_cast<std::size_t>(i)] = Vec3(s, 0, -2 * depth * std::min(s, 1 - s));
      }
      rod.q = orientation_towards(rod.p, Vec3::UnitY(), 0.1);
      rod.mass.front() = rod.mass.back() = 0.5 * length / edges;
      Scene scene;
      scene.rods.push_back(rod);
      scene.anchors = {{0, 0, true, false, {}}, {0, static_cast<std::size_t>(edges), true, false, {}}};
      scene.forces.push_back(std::make_shared<Gravity>(Vec3(0, 0, -1)));
      const System system(scene);
      const Equilibrium found = find_equilibrium(system, system.rest_state());
      ASSERT_EQ(found.balance, Balance::converged) << found.reason;
      EXPECT_LE(found.residual, kBalanced);
      EXPECT_LT(found.factorisations, 2000);
      error.push_back(-test::at(found.state.y, static_cast<std::size_t>(edges / 2)).z() - sag);
    }
    EXPECT_NEAR(test::order(error[0], error[1]), 2.0, 0.05) << tension;
    EXPECT_NEAR(test::order(error[1], error[2]), 2.0, 0.05) << tension;
  }
}

}  // namespace
}  // namespace tendril
