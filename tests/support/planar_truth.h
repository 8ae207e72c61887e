#pragma once

#include <gtest/gtest.h>
#include <tendril/dynamics/system.h>

#include <cstdio>
#include <limits>
#include <optional>
#include <string>

#include "support/planar_rod.h"

/// Runs of the library in the plane x z held to the equations of planar_rod.h: their right-hand side at a
/// state, and their own integration from rest.
namespace tendril::test {

inline std::vector<Vec2> in_plane(const Eigen::VectorXd& y, Eigen::Index first, std::size_t nodes) {
  std::vector<Vec2> out;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(nodes); ++i)
    out.emplace_back(y[first + 3 * i], y[first + 3 * i + 2]);
  return out;
}

/// Largest difference of the library's accelerations from the planar ones, over the largest of those and what
/// rounding of the positions makes of them: a spring k between masses m turns an error eps |p| of an end into
/// k eps |p| / m.
inline double acceleration_gap(const System& system, const PlanarRod& rod, const State& state) {
  const std::size_t n = system.node_count();
  const auto v_begin = static_cast<Eigen::Index>(3 * n);
  const auto work = system.make_workspace();
  Eigen::VectorXd rate;
  EXPECT_TRUE(system.derivative(state, state.time, state.y, rate, *work).ok());
  const std::vector<Vec2> p = in_plane(state.y, 0, n), found = in_plane(rate, v_begin, n);
  const std::vector<Vec2> expected = accelerations(rod, p, in_plane(state.y, v_begin, n));
  double gap = 0.0, size = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    const double spring = std::max(rod.stretch[i - 1], i < rod.stretch.size() ? rod.stretch[i] : 0.0);
    const double rounding = spring / rod.mass[i] * p[i].norm() * std::numeric_limits<double>::epsilon();
    size = std::max({size, expected[i].norm(), 1e10 * rounding});
    gap = std::max(gap, (found[i] - expected[i]).norm());
  }
  return gap / size;
}

/// Above all rates of the motion: frequencies w, and decays b w^2 by the viscosity b. The springs' part of
/// w^2 is at most the largest sum of the squares k |g|^2 (g the slope of a spring's measure, over the roots
/// of the masses) of the springs that meet at a node: two that stretch and three that bend.
inline double fastest(const PlanarRod& rod) {
  double axial = 0.0, bending = 0.0;
  for (std::size_t e = 0; e < rod.stretch.size(); ++e) {
    const double after = 1.0 / rod.length[e], before = e > 0 ? 1.0 / rod.length[e - 1] : 0.0;
    axial = std::max(axial, rod.stretch[e] * (1.0 / rod.mass[e] + 1.0 / rod.mass[e + 1]));
    double bend = after * after / rod.mass[e + 1];
    if (e > 0) bend += before * before / rod.mass[e - 1] + std::pow(before + after, 2) / rod.mass[e];
    bending = std::max(bending, (e > 0 ? 0.5 : 1.0) * rod.bend[e] * bend);
  }
  const double square = 2.0 * axial + 3.0 * bending;
  return std::max(std::sqrt(square), rod.viscosity * square);
}

/// Where the nodes are at `until`, from rest at p, by the classic Runge-Kutta method; nothing where that
/// takes more steps than `most`.
inline std::optional<std::vector<Vec2>> integrated(const PlanarRod& rod, std::vector<Vec2> p, double until,
                                                   double most) {
  const double steps = std::max(1e4, std::ceil(2.0 * fastest(rod) * until));  // many, for forces that jump
  if (!(steps <= most)) return {};
  const double h = until / steps;
  std::vector<Vec2> v(p.size(), Vec2::Zero());
  const auto moved = [](const std::vector<Vec2>& from, double by, const std::vector<Vec2>& rate) {
    std::vector<Vec2> out = from;
    for (std::size_t i = 1; i < out.size(); ++i) out[i] += by * rate[i];  // the first is held
    return out;
  };
  for (double k = 0; k < steps; ++k) {
    const auto a1 = accelerations(rod, p, v);
    const auto v2 = moved(v, 0.5 * h, a1), a2 = accelerations(rod, moved(p, 0.5 * h, v), v2);
    const auto v3 = moved(v, 0.5 * h, a2), a3 = accelerations(rod, moved(p, 0.5 * h, v2), v3);
    const auto v4 = moved(v, h, a3), a4 = accelerations(rod, moved(p, h, v3), v4);
    for (std::size_t i = 1; i < p.size(); ++i) {
      p[i] += h / 6.0 * (v[i] + 2.0 * v2[i] + 2.0 * v3[i] + v4[i]);
      v[i] += h / 6.0 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
    }
  }
  return p;
}

/// A state that a run from rest has come to.
/// \param tolerance  of the nodes' places, for a rod of length about 1
inline void expect_planar_motion(const System& system, const PlanarRod& rod, const State& state,
                                 double tolerance) {
  const double gap = acceleration_gap(system, rod, state);
  EXPECT_LT(gap, 1e-7) << "accelerations, of the largest";
  std::printf("  planar equations: accelerations agree to %.1e", gap);
  const std::size_t n = system.node_count();
  const auto end =
      integrated(rod, in_plane(system.rest_state().y, 0, n), state.time, 6e6 / static_cast<double>(n));
  double apart = 0.0;
  const std::vector<Vec2> p = in_plane(state.y, 0, n);
  for (std::size_t i = 0; end && i < n; ++i) apart = std::max(apart, (p[i] - (*end)[i]).norm());
  if (end) std::printf(", places to %.1e", apart);
  std::printf("\n");
  EXPECT_LT(apart, tolerance) << "places, by an integration of their own";
}

}  // namespace tendril::test
