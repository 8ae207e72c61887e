#pragma once

#include "workspace.h"

namespace tendril {

/// The equations of motion: y' at (t, y).
Evaluation rates(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                 Eigen::VectorXd& dy, System::Workspace& work);

/// The last number of y' alone, the power of what has no energy, where no spring resists and nothing that is
/// held moves: damping, and the forces of the scene.
Evaluation power_of_loads(const Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                          double& power, System::Workspace& work);

/// What forces see, from kinematics with all rates.
StateView view(const Model& model, double t, const Kinematics& kin, LoadColumns& loads);

/// Loads for forces to add to, set to zero.
Loads no_loads(const Kinematics& kin, LoadColumns& loads);

/// Whether a force that may do so refuses a state.
Evaluation refusal(const Model& model, const State& state, System::Workspace& work);

/// A force that gives no derivatives of its own.
struct Undifferentiated {
  const Model::Acting* acting;
  std::function<void(const StateView&, const Loads&)> add;  ///< in place of Force::add, or empty
};
/// Forces and spin torques of these, laid out like v' and w' in y'; everything else is 0.
Evaluation undifferentiated_loads(const Model& model, const State& reference, const Eigen::VectorXd& y,
                                  std::span<const Undifferentiated> forces, Eigen::VectorXd& out,
                                  System::Workspace& work);

}  // namespace tendril
