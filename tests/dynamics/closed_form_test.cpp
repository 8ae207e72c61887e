#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "support/statics.h"

namespace tendril {
namespace {

/// Cantilever of unit length and unit bending stiffness, thin enough to count as inextensible.
System cantilever(int edges, double radius = 5e-4) {
  Scene scene;
  const double young = 4.0 / (std::numbers::pi * std::pow(radius, 4));
  scene.rods.push_back(test::straight_rod(edges, young, radius));
  scene.anchors.push_back({0, 0, true, true, {}});
  return System(scene);
}

Vec3 tip_under_load(int edges, double load) {
  const System system = cantilever(edges);
  const auto tip = static_cast<std::size_t>(edges);
  return test::at(test::equilibrium(system, tip, Vec3(0, 0, -load), 4).y, tip);
}

struct Elastica {
  double load, drop, shortening, tolerance;
};
void PrintTo(const Elastica& exact, std::ostream* out) {
  *out << "load " << exact.load;
}

class TipLoad : public testing::TestWithParam<Elastica> {};
// Elliptic integrals: load P L^2 / E I, tip drop and shortening over L.
INSTANTIATE_TEST_SUITE_P(Elastica, TipLoad,
                         testing::Values(Elastica{1, 0.3017207738, 0.05643323628, 1.5e-4},
                                         Elastica{5, 0.7137915236, 0.3876283607, 5e-4},
                                         Elastica{10, 0.8106090249, 0.5549955978, 5.5e-4}));

TEST_P(TipLoad, ConvergesToTheElasticaAtOrderTwo) {
  const Elastica& exact = GetParam();
  const int edges[] = {16, 32, 64};
  double error[3];
  for (int i = 0; i < 3; ++i) {
    const Vec3 tip = tip_under_load(edges[i], exact.load);
    error[i] = std::hypot(-tip.z() - exact.drop, 1 - tip.x() - exact.shortening);
    std::printf("load %g, %d edges: drop %.6f, tip error %.2e of the length\n", exact.load, edges[i],
                -tip.z(), error[i]);
  }
  EXPECT_LT(error[1], exact.tolerance);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.1);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2.0, 0.1);
}

/// Lowest frequencies of small transverse motion, over sqrt(E I / rho A L^4).
Eigen::VectorXd bending_frequencies(int edges) {
  const System system = cantilever(edges, 1e-2);
  const test::FreeCoordinates free(system);
  const Eigen::MatrixXd k = test::stiffness(system, free, system.rest_state());
  // Transverse (z) coordinates only: the straight rod's motions do not mix.
  std::vector<Eigen::Index> z;
  for (Eigen::Index i = 2; i < k.rows(); i += 3) z.push_back(i);
  Eigen::VectorXd inverse_root(static_cast<Eigen::Index>(z.size()));
  for (Eigen::Index i = 0; i < inverse_root.size(); ++i)
    inverse_root[i] = 1 / std::sqrt(system.scene().rods[0].mass[static_cast<std::size_t>(i) + 1]);
  const Eigen::MatrixXd weighted =
      inverse_root.asDiagonal() * Eigen::MatrixXd(k(z, z)) * inverse_root.asDiagonal();
  const double line_density = 1000 * std::numbers::pi * 1e-4;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weighted);
  return (solver.eigenvalues() * line_density).cwiseSqrt();
}

TEST(ClampedFree, BendingFrequenciesConvergeToEulerAndBernoulli) {
  const double root[] = {1.875104069, 4.694091133, 7.854757438};
  const double tolerance[] = {1e-3, 5e-3, 1e-2};
  const Eigen::VectorXd at32 = bending_frequencies(32);
  const Eigen::VectorXd at64 = bending_frequencies(64);
  for (int k = 0; k < 3; ++k) {
    const double exact = root[k] * root[k];
    const double error = std::abs(at32[k] / exact - 1);
    const double finer = std::abs(at64[k] / exact - 1);
    std::printf("frequency %d: relative error %.2e at 32 edges, order %.2f\n", k + 1, error,
                std::log2(error / finer));
    EXPECT_LT(error, tolerance[k]);
    EXPECT_NEAR(std::log2(error / finer), 2.0, 0.1);
  }
}

TEST(Section, IntegralsMatchTheirClosedForms) {
  const double r = 0.3;
  const Section circle = circular_section(r);
  EXPECT_DOUBLE_EQ(circle.area, std::numbers::pi * r * r);
  EXPECT_DOUBLE_EQ(circle.bending1, circle.bending2);
  EXPECT_NEAR(circle.torsion, std::numbers::pi * std::pow(r, 4) / 2, 1e-16);
  EXPECT_NEAR(circle.polar, circle.torsion, 1e-16);
  // Square: J = 0.1405770149 a^4 (Timoshenko and Goodier give 0.1406); thin strip: a b^3 / 3 (1 - 0.63025 b /
  // a).
  EXPECT_NEAR(rectangular_section(2, 2).torsion / 16, 0.1405770149, 1e-9);
  EXPECT_NEAR(rectangular_section(1, 1e-3).torsion / (1e-9 / 3), 1 - 0.630249e-3, 1e-8);
  EXPECT_DOUBLE_EQ(rectangular_section(2, 5).torsion, rectangular_section(5, 2).torsion);
  EXPECT_DOUBLE_EQ(rectangular_section(2, 6).bending1, 8 * 6 / 12.0);
}

}  // namespace
}  // namespace tendril
