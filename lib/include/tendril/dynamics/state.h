#pragma once

#include <tendril/base/types.h>

#include <memory>
#include <vector>

namespace tendril {

struct ForceMemory;

/// The state of all rods and bodies: the integrated numbers y, and the frames they are measured against.
///
/// y = (p 3n | v 3n | theta m | w m | x 3k | phi 3k | u 3k | omega 3k | work 1), n nodes, m of them with
/// twist (all of a rod or none), k free bodies. theta_i is the angle of the director against `director[i]`
/// carried from `tangent[i]` to the tangent by the smallest rotation; w_i the spin about the tangent; x and u
/// place and velocity of a centre of mass; phi the rotation vector from `rotation` to the body's rotation,
/// exp([phi]) rotation, and omega its angular velocity, both in the world; work that done so far by forces
/// without an energy, by damping and by moving anchors.
///
/// Of a rod without twist state only one node's reference is kept (the last with a held frame, or the first):
/// the others' directors follow it along the rod. System::frames has them all.
struct State {
  double time = 0.0;           ///< [time]
  Eigen::VectorXd y;           ///< the integrated numbers
  std::vector<Vec3> tangent;   ///< reference tangents, unit; renewed after every accepted step
  std::vector<Vec3> director;  ///< reference directors m, unit and across the tangents; renewed with them
  std::vector<double> twist;   ///< unwrapped twist of each edge at the reference [rad]
  /// What the scene's forces remember (System::remember); empty or null where nothing.
  std::vector<std::shared_ptr<const ForceMemory>> memory = {};
  std::vector<Mat3> rotation = {};  ///< of each body at the reference, orthonormal; renewed with the tangents
};

/// Whether the equations could be evaluated, and if not, why and where.
struct Evaluation {
  /// What happened.
  enum class Outcome {
    ok,              ///< evaluated
    zero_edge,       ///< an edge of length 0
    fold_back,       ///< two opposite edges at a node, or one past half a turn from a held frame
    turned_too_far,  ///< a tangent or a body turned by over 126 degrees from its reference
    not_finite,      ///< a number that overflowed, or was not finite to begin with
    not_converged,   ///< an implicit step's equations
    refused,         ///< a force refused the state: Loads::refuse
    coupled_too_far  ///< forces couple too many nodes there for an implicit step: Couplings
  };
  Outcome outcome = Outcome::ok;                      ///< why
  std::size_t node = 0;                               ///< where: flat index; n + 2b or n + 2b + 1 is body b
  bool ok() const { return outcome == Outcome::ok; }  ///< whether results may be used
};

/// Energies in the scene's units. total() + work taken out is constant up to the integration error.
struct Energies {
  double kinetic = 0.0;                                           ///< of masses, spins and bodies
  double elastic = 0.0;                                           ///< of all springs
  double potential = 0.0;                                         ///< of the forces that have an energy
  double total() const { return kinetic + elastic + potential; }  ///< their sum
};

}  // namespace tendril
