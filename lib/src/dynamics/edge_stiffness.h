#pragma once

#include <Eigen/Core>

#include <array>

#include "workspace.h"

namespace tendril {

/// Second derivatives of the elastic energy by the positions of four neighbouring nodes and the angles of the
/// middle two: what the springs of one edge see. Order: p_{i-1}, p_i, p_{i+1}, p_{i+2}, theta_i, theta_{i+1};
/// what is not there is 0.
using EdgeStiffness = Eigen::Matrix<double, 14, 14>;

/// Exact stiffness of edge i in the coordinates (p, theta) about a state that is its own reference. The
/// workspace must hold the kinematics, the elastic gradient and its pull-back (kinematics, elastic,
/// add_pulled_back in that order).
///
/// Three levels, each exact: the springs' second derivatives by the unit edge e, the tangents t and the
/// angles theta; the curvature of t(e) weighted with dE/dt; the curvature of e(p) weighted with dE/de. The
/// last two are counted with the edge, and with the edge that begins at the node.
EdgeStiffness edge_stiffness(const System::Model& model, const NodeRange& rod, std::size_t i,
                             const State& reference, const System::Workspace& work);

/// Resistance of edge i in the same coordinates: sum k grad q grad q^T over stretch, the two deviations and
/// the twist. Times the viscosity it is minus the viscous forces' derivative by the velocities.
EdgeStiffness edge_resistance(const System::Model& model, const NodeRange& rod, std::size_t i,
                              const System::Workspace& work);

/// Places of those coordinates among n positions and m angles (the order of System::elastic_gradient), -1 for
/// what is not there.
std::array<Eigen::Index, 14> edge_places(const System::Model& model, const NodeRange& rod, std::size_t i);

}  // namespace tendril
