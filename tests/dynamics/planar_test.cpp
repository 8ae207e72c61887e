#include "support/planar_rod.h"

#include <gtest/gtest.h>
#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/system.h>

#include "support/random.h"

// The right-hand side against one of its own for motions in a plane, which shares no code with it.
namespace tendril {
namespace {

using test::PlanarRod;
using test::Vec2;

constexpr double kYoung = 1e6, kRadius = 5e-3, kDensity = 1000;

/// The plane x z, with the clamp at the origin.
Vec3 in_space(const Vec2& a) {
  return {a.x(), 0.0, a.y()};
}

struct Planar {
  std::string name;
  double damping = 0.0, viscosity = 0.0, wind = 0.0, stiffer = 1.0, longer = 1.0;
  double tolerance = 1e-12;  ///< of the largest acceleration
};
void PrintTo(const Planar& one, std::ostream* out) {
  *out << one.name;
}

/// A rod curved at rest, its edges of three lengths; every second edge and its bending springs stiffer.
std::vector<Vec2> rest_of(const Planar& one) {
  std::vector<Vec2> rest{Vec2::Zero()};
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.3 * std::sin(i), length = i % 3 == 0 ? one.longer : 1.0 + 0.2 * (i % 3);
    rest.push_back(rest.back() + length / 16.0 * Vec2(std::cos(angle), std::sin(angle)));
  }
  return rest;
}

Scene scene_of(const Planar& one, const std::vector<Vec2>& rest) {
  std::vector<Vec3> p;
  for (const Vec2& at : rest) p.push_back(in_space(at));
  Scene scene;
  scene.rods.push_back(make_rod(p, orientation_towards(p, Vec3::UnitY(), 0.1), {kYoung, kYoung / 3, kDensity},
                                circular_section(kRadius)));
  Rod& rod = scene.rods[0];
  rod.mass_damping = one.damping;
  rod.viscosity = one.viscosity;
  for (std::size_t i = 1; i < rod.stretch.size(); i += 2)
    for (double* k : {&rod.stretch[i], &rod.bend_l[i], &rod.bend_m[i]}) *k *= one.stiffer;
  scene.anchors.push_back({.rod = 0, .node = 0});
  scene.forces.push_back(std::make_shared<Gravity>(Vec3(0.4, 0, -9.81)));
  if (one.wind > 0.0) {
    WindOptions air;
    air.mean = one.wind * Vec3(0.8, 0, 0.6);
    scene.forces.push_back(std::make_shared<Wind>(air));
  }
  return scene;
}

PlanarRod planar_of(const Planar& one, const std::vector<Vec2>& rest) {
  PlanarRod rod = test::planar_rod(rest, kYoung, kRadius, kDensity);
  rod.damping = one.damping;
  rod.viscosity = one.viscosity;
  for (std::size_t i = 1; i < rod.stretch.size(); i += 2)
    for (double* k : {&rod.stretch[i], &rod.bend[i]}) *k *= one.stiffer;
  rod.gravity = {0.4, -9.81};
  if (one.wind > 0.0) {
    rod.air = one.wind * Vec2(0.8, 0.6);
    rod.air_density = 1.2;
    rod.normal_drag = 1.2;
    rod.tangential_drag = 0.02;
  }
  return rod;
}

class PlanarMotion : public testing::TestWithParam<Planar> {};

TEST_P(PlanarMotion, HasTheAccelerationsOfEquationsWrittenInThePlane) {
  const Planar& one = GetParam();
  const std::vector<Vec2> rest = rest_of(one);
  const System system(scene_of(one, rest));
  const auto work = system.make_workspace();
  test::Random random(3);
  const auto n = static_cast<Eigen::Index>(rest.size());
  double worst = 0.0;
  for (int pose = 0; pose < 20; ++pose) {
    std::vector<Vec2> p = rest, v(rest.size(), Vec2::Zero());
    State state = system.rest_state();
    for (std::size_t i = 1; i < p.size(); ++i) {
      const Vec3 moved = random.in_cube(0.02), thrown = random.in_cube(3.0);
      p[i] += Vec2(moved.x(), moved.z());
      v[i] = Vec2(thrown.x(), thrown.z());
      const auto k = 3 * static_cast<Eigen::Index>(i);
      state.y.segment<3>(k) = in_space(p[i]);
      state.y.segment<3>(3 * n + k) = in_space(v[i]);
    }
    Eigen::VectorXd rate;
    ASSERT_TRUE(system.derivative(state, 0.0, state.y, rate, *work).ok());
    const std::vector<Vec2> expected = test::accelerations(planar_of(one, rest), p, v);
    double largest = 0.0, gap = 0.0;
    for (std::size_t i = 1; i < p.size(); ++i) {
      const auto k = 3 * (n + static_cast<Eigen::Index>(i));
      largest = std::max(largest, expected[i].norm());
      gap = std::max(gap, (Vec3(rate.segment<3>(k)) - in_space(expected[i])).norm());
    }
    worst = std::max(worst, gap / largest);
  }
  std::printf("%s: %.1e of the largest acceleration\n", one.name.c_str(), worst);
  EXPECT_LT(worst, one.tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Rods, PlanarMotion,
    testing::Values(Planar{.name = "Undamped"}, Planar{.name = "Damped", .damping = 0.7},
                    Planar{.name = "InWind", .wind = 20.0}, Planar{.name = "Viscous", .viscosity = 1e-3},
                    Planar{.name = "EdgesApartInStiffness", .stiffer = 1e10},
                    Planar{.name = "EdgesApartInLength", .longer = 100.0},
                    Planar{.name = "All", .damping = 0.7, .viscosity = 1e-2, .wind = 20.0}),
    [](const testing::TestParamInfo<Planar>& shown) { return shown.param.name; });

}  // namespace
}  // namespace tendril
