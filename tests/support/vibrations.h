#pragma once

#include <tendril/dynamics/stiffness.h>

#include <Eigen/Eigenvalues>

#include "support/statics.h"

namespace tendril::test {

/// Small motions about a state at rest that is its own reference: K x = w^2 M x over the free coordinates
/// that are asked for, with the exact Hessian of the elastic energy.
struct Vibrations {
  std::vector<Eigen::Index> y;  ///< places of the coordinates in a state's y
  Eigen::VectorXd frequency;    ///< [rad / time], ascending
  Eigen::MatrixXd shape;        ///< a column each; x^T M x = 1
};

/// The masses of all coordinates in the order of the gradient; roots of children stand with the nodes they
/// ride on.
inline Eigen::VectorXd masses(const System& system) {
  const auto n = static_cast<Eigen::Index>(system.node_count());
  Eigen::VectorXd out = Eigen::VectorXd::Zero(3 * n + static_cast<Eigen::Index>(system.twist_count()));
  const std::vector<double> inertia = spin_inertias(system);
  for (std::size_t r = 0; r < system.rods().size(); ++r)
    for (std::size_t i = 0; i < system.rods()[r].count; ++i) {
      const auto node = static_cast<Eigen::Index>(system.rods()[r].first + i);
      out.segment<3>(3 * node).setConstant(system.scene().rods[r].mass[i]);
      if (system.twist_count() > 0) out[3 * n + node] = inertia[system.rods()[r].first + i];
    }
  for (const Joint& joint : system.scene().joints) {
    const auto at = static_cast<Eigen::Index>(system.rods()[joint.parent].first + joint.node);
    out.segment<3>(3 * at).array() += system.scene().rods[joint.child].mass[0];
  }
  return out;
}

/// \param wanted  whether a coordinate, by its place in the gradient (3n positions, then the angles), takes
/// part
template <typename Wanted>
Vibrations vibrations(const System& system, const State& state, Wanted wanted) {
  const FreeCoordinates free(system);
  Vibrations out;
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < free.y.size(); ++k) {
    if (!wanted(free.gradient[k])) continue;
    out.y.push_back(free.y[k]);
    rows.push_back(free.gradient[k]);
  }
  Eigen::SparseMatrix<double> sparse;
  if (!elastic_stiffness(system, state, sparse, *system.make_workspace()).ok())
    throw std::runtime_error("no stiffness");
  const Eigen::VectorXd root = masses(system)(rows).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd k = Eigen::MatrixXd(sparse)(rows, rows);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.asDiagonal() * k * root.asDiagonal());
  out.frequency = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  out.shape = root.asDiagonal() * solver.eigenvectors();
  return out;
}

}  // namespace tendril::test
