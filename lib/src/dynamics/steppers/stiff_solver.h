#pragma once

#include <memory>

#include "dynamics/rhs/workspace.h"

namespace tendril {

/// The linear equations of an implicit step, (s - J) U = r with J the Jacobian of y' at a state that is its
/// own reference, in second-order form: with x the free positions and angles, u their rates, M the masses,
/// x' = u + c(x), M u' = F(t, x, u),
///
///     (s^2 M - s F_u - F_x - s M C + F_u C) U_x = M r_u + s M r_x - F_u r_x,   U_u = (s - C) U_x - r_x.
///
/// Blocks of three or four numbers a node, eliminated from the rods' tips to their roots and from children to
/// parents, then two of three a body: O(n) time and memory. Without twist, bodies and loads that depend on
/// the state everything is symmetric, and only half of it is kept.
///
/// Exact are the derivatives of the springs, of the gyroscopic forces, of the connection term, and those that
/// external forces give of their own; how fast the directions of viscous springs turn is taken by a central
/// difference along the motion. Other external forces that depend on the state are differentiated by
/// differences, coloured so that nodes that share no row share an evaluation.
class StiffSolver {
 public:
  virtual ~StiffSolver() = default;

  /// Takes the Jacobian at a state.
  /// \param rate  y' there
  /// \return  the number of evaluations of the equations (or of parts of them) it cost, negative when one
  ///          failed, as failure() says
  virtual long differentiate(const State& state, const Eigen::VectorXd& rate) = 0;
  const Evaluation& failure() const { return failure_; }

  /// False when elimination breaks down.
  virtual bool factor(double s) = 0;

  /// U and r laid out like y; held coordinates and the work get 0.
  virtual void solve(double s, const Eigen::VectorXd& r, Eigen::VectorXd& result) = 0;

  /// Derivative of y' by time; empty when nothing depends on time.
  const Eigen::VectorXd& by_time() const { return by_time_; }

 protected:
  /// Whether it failed, which is kept.
  bool fails(const Evaluation& evaluation) {
    failure_ = evaluation;
    return !evaluation.ok();
  }

  Eigen::VectorXd by_time_;

 private:
  Evaluation failure_;
};

/// \param system, work  kept by reference
std::unique_ptr<StiffSolver> make_stiff_solver(const System& system, System::Workspace& work);

}  // namespace tendril
