#pragma once

#include "workspace.h"

namespace tendril {

constexpr double kFoldBack = 1e-9;     ///< least length of the sum of two unit edges that gives a tangent
constexpr double kTurnedTooFar = 0.4;  ///< least 1 + t_s . t

/// Fills kinematics from y. For springs alone, numbers in y that are not finite may pass: they make the
/// forces so. Not where others see them.
Evaluation kinematics(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      Motion what, Kinematics& kin);

/// The velocities and spins of y alone, of what is not held.
void take_velocities(const Model& model, const Eigen::VectorXd& y, Kinematics& kin);

}  // namespace tendril
