#pragma once

#include <tendril/dynamics/forces.h>
#include <tendril/dynamics/statics.h>

#include <ctime>
#include <numeric>
#include <stdexcept>

#include "support/rods.h"

namespace tendril::test {

/// Straight rod of unit length and unit bending stiffness along x, thin enough to count as inextensible.
inline Rod unit_rod(int edges, double radius = 2e-4) {
  return straight_rod(edges, 4.0 / (std::numbers::pi * std::pow(radius, 4)), radius);
}

/// The same by the thesis's constants: bending B by the third spring alone, which is the same all round;
/// torsion C, tension E A.
inline Rod round_rod(int edges, double length, double bending, double torsion, double tension) {
  const std::vector<Vec3> p = straight(edges, length);
  const double h = length / edges;
  const SpringConstants springs{.stretch = tension / h,
                                .bend_l = 0.0,
                                .bend_m = 0.0,
                                .bend_t = 2 * bending / h,
                                .twist = torsion / h,
                                .mass = h,
                                .inertia = h};
  return make_rod(p, orientation_towards(p, Vec3::UnitZ(), 0.1), springs);
}

inline std::shared_ptr<const Force> point_load(PointLoad::Kind kind, int node, const Vec3& load) {
  return std::make_shared<PointLoad>(kind, 0, static_cast<std::size_t>(node), load, Signal::constant(1.0));
}

/// A clamp that moves straight and turns about x at even rates.
inline Anchor mover(std::size_t node, const Vec3& from, const Vec3& velocity, double turning) {
  Anchor anchor{0, node, true, true, {}};
  const Frame frame = frame_towards(Vec3::UnitX(), Vec3::UnitZ()).frame;
  anchor.motion = [=](double t) {
    const auto turned = [&](const Vec3& v) { return rotate_about(Vec3::UnitX(), turning * t, v); };
    return AnchorPose{
        from + t * velocity, {turned(frame.x), turned(frame.y), frame.z}, velocity, turning * Vec3::UnitX()};
  };
  return anchor;
}

/// From a state, by default the rest; throws when it is not found to so many times the tolerance.
inline Equilibrium balanced_from(const System& system, State start, const StaticsOptions& options = {},
                                 double tolerances = 1.0) {
  Equilibrium found = find_equilibrium(system, std::move(start), options);
  if (found.balance != Balance::converged) throw std::runtime_error("no equilibrium: " + found.reason);
  if (!(found.last_step <= tolerances * options.tolerance))
    throw std::runtime_error("no equilibrium: balanced, but the last step is " +
                             std::to_string(found.last_step / options.tolerance) + " tolerances");
  return found;
}
inline Equilibrium balanced(const System& system, const StaticsOptions& options = {},
                            double tolerances = 1.0) {
  return balanced_from(system, system.rest_state(), options, tolerances);
}

/// A rod clamped at its first node.
inline Equilibrium clamped(Rod rod, std::vector<std::shared_ptr<const Force>> forces,
                           const StaticsOptions& options = {}) {
  Scene scene;
  scene.rods.push_back(std::move(rod));
  scene.anchors.push_back({0, 0, true, true, {}});
  scene.forces = std::move(forces);
  return balanced(System(scene), options);
}

inline Vec3 tip(const Equilibrium& found) {
  return at(found.state.y, found.state.tangent.size() - 1);
}

inline double total_mass(const Rod& rod) {
  return std::accumulate(rod.mass.begin(), rod.mass.end(), 0.0);
}

/// Positions of the masses in the plane x z.
inline std::vector<std::pair<double, double>> side_view(const State& state) {
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < state.tangent.size(); ++i)
    out.emplace_back(at(state.y, i).x(), at(state.y, i).z());
  return out;
}

inline double order(double coarse, double fine) {
  return std::log2(std::abs(coarse) / std::abs(fine));
}

/// A root of f between two guesses, by secants.
template <typename F>
double root_of(F f, double a, double b, double tolerance) {
  double fa = f(a);
  for (int i = 0; i < 40 && std::abs(b - a) > tolerance; ++i) {
    const double fb = f(b);
    const double c = b - fb * (b - a) / (fb - fa);
    a = b;
    fa = fb;
    b = c;
  }
  return b;
}

inline double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace tendril::test
