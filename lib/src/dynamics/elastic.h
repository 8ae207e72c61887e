#pragma once

#include "workspace.h"

namespace tendril {

constexpr double kFoldBack = 1e-9;     ///< least length of the sum of two unit edges that gives a tangent
constexpr double kTurnedTooFar = 0.4;  ///< least 1 + t_s . t

bool all_finite(const Eigen::VectorXd& values);

/// What kinematics are filled: places and frames; what the springs need, with rates; or all, with rates.
enum class Motion { places, springs, all };

/// Fills the workspace's kinematics from y. For springs alone, numbers in y that are not finite may pass:
/// they make the forces so.
Evaluation kinematics(const System::Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      Motion what, System::Workspace& work);

/// What acts beside the elastic springs: with `viscous` every spring but the third on strain + beta strain';
/// the gyroscopic force of the spins, through the tangents. Both need rates.
struct Inner {
  bool viscous, gyroscopic;
};

/// Gradient of the elastic energy at the kinematics. Fails where two edges fold back on each other.
/// \param heat  power turned into heat, when viscous
Evaluation elastic(const System::Model& model, const State& reference, Inner inner, System::Workspace& work,
                   double& heat);

/// The elastic energy with its gradient.
Evaluation elastic_energy(const System::Model& model, const State& reference, System::Workspace& work,
                          double& energy);

/// The gradient of no springs at all.
void relax(const System::Model& model, bool gyroscopic, System::Workspace& work);

/// Turns the gradient by tangents and edges into forces along the edges.
void pull_on_edges(const System::Model& model, System::Workspace& work);

/// The same, and these into forces on the masses, in work.force. The tangents of held
/// frames do not depend on the masses; what the root of a child rod feels goes to the node it rides on.
void pull_back(const System::Model& model, System::Workspace& work);

/// The equations of motion: y' at (t, y), with or without the springs and their viscous parts.
Evaluation rates(const System::Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                 bool springs, Eigen::VectorXd& dy, System::Workspace& work);

/// What forces see, from the workspace's kinematics with all rates.
StateView view(const System::Model& model, double t, System::Workspace& work);

/// Forces and spin torques, laid out like v' and w' in y', of the external forces that depend on the state
/// and do not give their derivatives; everything else is 0.
Evaluation undifferentiated_loads(const System::Model& model, const State& reference,
                                  const Eigen::VectorXd& y, Eigen::VectorXd& loads, System::Workspace& work);

}  // namespace tendril
