#pragma once

#include "band.h"
#include "workspace.h"

namespace tendril {

/// The free coordinates x = (p_i, theta_i) of chains, node by node, with their rates u = (v_i, w_i): where
/// each stands in y, and its mass. Held coordinates are left out.
struct ChainCoordinates {
  explicit ChainCoordinates(const System::Model& model);

  Eigen::Index size() const { return static_cast<Eigen::Index>(x.size()); }
  std::vector<Eigen::Index> x, u;  ///< places in y
  std::vector<double> mass;
  std::vector<std::size_t> node;    ///< flat
  std::vector<Eigen::Index> first;  ///< per node, its first coordinate; first[n] is the size
  Eigen::Index half = 0;            ///< half-bandwidth of what couples
};

/// Jacobian of x' = u + c(x, u), u' = a(t, x, u) at a state that is its own reference: a by x, a by u, c by x
/// (the connection term; c by u is 0 there), and the derivative by time.
///
/// Springs and their viscous parts are exact: accelerations -M^-1 K, -M^-1 sum beta k grad q grad q^T. What
/// is left (gyroscopic force, connection term, external forces that depend on the state, and the change of
/// the viscous forces' directions, which is left out) is differentiated by differences, coloured so that
/// nodes seven apart share an evaluation.
struct ChainJacobian {
  ChainJacobian(const ChainCoordinates& coordinates, bool connected);

  BandMatrix a_by_x, a_by_u, c_by_x;
  bool connected;           ///< whether c_by_x is there
  Eigen::VectorXd by_time;  ///< of all of y'; empty when nothing depends on time
};

/// \param rate  y' at the state
/// Returns the number of evaluations of the equations (or of parts of them) it cost, negative when one
/// failed.
long differentiate(const System& system, const ChainCoordinates& coordinates, const State& state,
                   const Eigen::VectorXd& rate, System::Workspace& work, ChainJacobian& jacobian);

}  // namespace tendril
