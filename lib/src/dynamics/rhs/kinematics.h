#pragma once

#include "workspace.h"

namespace tendril {

constexpr double kFoldBack = 1e-9;     ///< least length of the sum of two unit edges that gives a tangent
constexpr double kTurnedTooFar = 0.4;  ///< least 1 + t_s . t

/// What kinematics are filled: positions and frames; what the springs need, with rates; or all, with rates.
enum class Motion { positions, springs, all };

/// Fills the workspace's kinematics from y. For springs alone, numbers in y that are not finite may pass:
/// they make the forces so.
Evaluation kinematics(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      Motion what, System::Workspace& work);

}  // namespace tendril
