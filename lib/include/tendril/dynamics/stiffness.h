#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/system.h>

#include <Eigen/SparseCore>

namespace tendril {

/// Exact Hessian of the elastic energy at a state that is its own reference (as after System::rebase):
/// symmetric, in the coordinates and order of System::elastic_gradient (3n positions, then m angles). Rows of
/// held coordinates are not removed; those of a child's first node are empty, as its entries belong to the
/// parent's node that it is fixed to. Through a one-way joint the parent feels nothing: then it is the
/// derivative of minus the elastic forces, and not symmetric. A node couples with its third neighbour; O(n)
/// time and entries. On failure the matrix is not to be used.
TENDRIL_CORE_API Evaluation elastic_stiffness(const System& system, const State& state,
                                              Eigen::SparseMatrix<double>& stiffness,
                                              System::Workspace& work);

}  // namespace tendril
