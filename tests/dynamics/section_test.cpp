#include <gtest/gtest.h>
#include <tendril/dynamics/section.h>

#include <cmath>
#include <numbers>

namespace tendril {
namespace {

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
