#pragma once

#include <array>
#include <limits>

#include "dynamics/rhs/workspace.h"

namespace tendril {

/// Projects on the plane across a unit vector.
inline Mat3 projector(const Vec3& n) {
  return Mat3::Identity() - n * n.transpose();
}

/// Second derivatives of the elastic energy by what the springs of one edge see: the positions of up to five
/// nodes and the angles of two. Positions attached to another node stand under the node that carries them.
struct EdgeStiffness {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::array<std::size_t, 5> node;   ///< in the order of the positions; kNone for what is not there
  std::array<std::size_t, 2> angle;  ///< nodes whose angles come last
  std::array<bool, 5> node_feels{};  ///< whether the row acts: nobody feels through a one-way joint
  std::array<bool, 2> angle_feels{};
  Mat3 k[5][5];         ///< by the positions of slots a <= b; the rest by symmetry
  Vec3 by_angle[5][2];  ///< position by angle
  double angles[2][2];
};

/// Exact stiffness of edge i of a rod with twist, in the coordinates (p, theta) about a state that is its own
/// reference. The workspace must hold the kinematics, the elastic gradient and its pull-back.
///
/// Three levels, each exact: the springs' second derivatives by the unit edge e, the tangents t and the
/// angles theta; the curvature of t(e) weighted with dE/dt; the curvature of e(p) weighted with dE/de. The
/// last two are counted with the edge, and with the edge that begins at the node. The first edge of a child
/// rod sees its parent's frame: one more level, the turn of the child's frame by the parent's (t, theta).
///
/// With `viscous` the workspace must hold the rates and the gradient with its viscous part: then what is
/// weighted with slopes counts that part too. How the directions of the viscous forces turn:
/// turned_resistance.
void edge_stiffness(const Model& model, const NodeRange& rod, std::size_t i, const Kinematics& kin,
                    const Gradient& grad, bool viscous, EdgeStiffness& to);

/// Resistance of edge i in the same coordinates: sum k grad q grad q^T over stretch, the two deviations and
/// the twist. Times the viscosity it is minus the viscous forces' derivative by the velocities.
void edge_resistance(const Model& model, const NodeRange& rod, std::size_t i, const Kinematics& kin,
                     EdgeStiffness& to);

/// Gradients of what the bending and twist springs of one edge see (the two deviations at either end, the
/// twist), in the coordinates of EdgeStiffness.
struct EdgeSlopes {
  static constexpr std::size_t kSprings = 5;
  Vec3 node[kSprings][5];
  double angle[kSprings][2];
};

/// At any state near the reference, so that their rate along a motion is the derivative of q' by the
/// coordinates; the workspace must hold its places and frames.
void edge_slopes(const Model& model, const NodeRange& rod, std::size_t i, const State& reference,
                 const Kinematics& kin, EdgeSlopes& to);

/// Gradient of the moment T at a hub by what the first edge of one of its children sees.
struct HubSlopes {
  EdgeStiffness place;  ///< only where its rows and columns stand
  Vec3 node[2][5];
  double angle[2][2];
};
void hub_slopes(const Model& model, const Model::Hub::Child& child, const State& reference,
                const Kinematics& kin, HubSlopes& to);

/// How the directions of edge i's viscous bending and twist turn: sum k grad q (d grad q / dt)^T, q' being
/// grad q . x' and so its derivative by x the rate of grad q. Rows by columns, not symmetric.
struct TurnedResistance {
  EdgeStiffness place;  ///< only where its rows and columns stand
  Mat3 k[5][5];
  Vec3 by_angle[5][2], of_angle[2][5];
  double angles[2][2];
};
void turned_resistance(const Model& model, const NodeRange& rod, std::size_t i, const EdgeSlopes& slopes,
                       const EdgeSlopes& rates, TurnedResistance& to);

/// Stretch of edge i, by the vector d along it: k e e^T + k (1 - L / l) (1 - e e^T).
Mat3 stretch_stiffness(const Model& model, std::size_t i, const Kinematics& kin);

/// Derivative of the viscous pull k beta (e.v) e of edge i by the vector d along it, v its rate:
/// k beta (e (v - (e.v) e)^T + (e.v) (1 - e e^T)) / l. Needs the velocities.
Mat3 turned_pull(const Model& model, std::size_t i, const Kinematics& kin);

/// 1/2 K angle^2 between edge i and the held frame of `node` at one of its ends, by the vector along the
/// edge.
Mat3 held_hinge_stiffness(const Model& model, std::size_t node, std::size_t i, const Kinematics& kin);

}  // namespace tendril
