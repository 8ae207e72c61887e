#pragma once

#include "workspace.h"

namespace tendril {

/// Fills the workspace's kinematics from y. Rates only when asked for.
Evaluation kinematics(const System::Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                      bool rates, System::Workspace& work);

/// Elastic energy at the kinematics, its gradient into g_edge, g_length, g_tangent and g_spin. With `viscous`
/// (needs rates) every spring but the third acts on strain + beta strain'; returned is still the elastic
/// energy. \param dissipated  power turned into heat, when viscous
double elastic(const System::Model& model, const State& reference, bool viscous, System::Workspace& work,
               double& dissipated);

/// The gradient of no springs at all.
void relax(System::Workspace& work);

/// Turns g_edge, g_length and g_tangent into forces on the masses, added to work.force. The tangents of held
/// frames do not depend on the masses.
void add_pulled_back(const System::Model& model, System::Workspace& work);

/// The equations of motion: y' at (t, y), with or without the springs and their viscous parts.
Evaluation rates(const System::Model& model, const State& reference, double t, const Eigen::VectorXd& y,
                 bool springs, Eigen::VectorXd& dy, System::Workspace& work);

}  // namespace tendril
