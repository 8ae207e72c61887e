#pragma once

#include "workspace.h"

namespace tendril {

/// What acts beside the elastic springs: with `viscous` every spring but the third on strain + beta strain';
/// the gyroscopic force of the spins, through the tangents. Both need rates.
struct Inner {
  bool viscous, gyroscopic;
};

/// Gradient of the elastic energy at the kinematics. Fails where two edges fold back on each other.
/// \param heat  power turned into heat, when viscous
Evaluation elastic(const Model& model, const State& reference, Inner inner, const Kinematics& kin,
                   Gradient& grad, double& heat);

/// The elastic energy with its gradient.
Evaluation elastic_energy(const Model& model, const State& reference, const Kinematics& kin, Gradient& grad,
                          double& energy);

/// The gradient of no springs at all.
void relax(const Kinematics& kin, Gradient& grad);

}  // namespace tendril
