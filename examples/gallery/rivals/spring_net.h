#pragma once

#include <tendril/base/types.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tendril::gallery {

/// 1/2 K (|p_b - p_a| - rest)^2.
struct Spring {
  std::uint32_t a, b;
  double stiffness, rest;
};

/// 1/2 K (angle - rest)^2, the unsigned angle between the edges a b and b c.
struct AngleSpring {
  std::array<std::uint32_t, 3> nodes;
  double stiffness, rest;
};

/// Masses joined by springs, as they are put on the vertices of a mesh, on the control points of a lattice
/// or on a chain: what the thesis compares its curve-pair with. Plain data.
struct SpringNet {
  std::vector<Vec3> rest;  ///< of the masses
  std::vector<double> mass;
  std::vector<Spring> springs;
  std::vector<AngleSpring> angles = {};
  std::vector<std::uint32_t> held = {};  ///< masses that do not move by forces
  /// Velocity of a held mass; empty: they rest.
  std::function<Vec3(std::uint32_t mass, double time)> driven = {};
  /// On every mass [length / time^2]; empty: none.
  std::function<Vec3(double time)> acceleration = {};
  double damping = 0.0;  ///< alpha: force -alpha m v
};

/// A spring between two masses that stand at their rest.
Spring spring_between(std::span<const Vec3> rest, std::uint32_t a, std::uint32_t b, double stiffness);
/// The same between two edges of a chain.
AngleSpring angle_at(std::span<const Vec3> rest, std::uint32_t middle, double stiffness);

/// Adds the springs' forces on masses at p.
void add_forces(const SpringNet& net, std::span<const Vec3> p, std::span<Vec3> force);
/// Elastic energy of masses at p.
double elastic_energy(const SpringNet& net, std::span<const Vec3> p);

/// Largest frequency of small oscillations about p, by power iteration [rad / time].
double largest_frequency(const SpringNet& net, std::span<const Vec3> p);

}  // namespace tendril::gallery
