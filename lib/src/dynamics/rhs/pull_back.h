#pragma once

#include "workspace.h"

namespace tendril {

/// Turns the gradient by tangents and edges into forces along the edges.
void pull_on_edges(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads, Pull& pull);

/// The same, and these into forces on the masses, in pull.force. The tangents of held
/// frames do not depend on the masses; what the root of a child rod feels goes to the node it is attached to.
void pull_back(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads, Pull& pull);

}  // namespace tendril
