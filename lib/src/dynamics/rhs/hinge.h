#pragma once

#include "workspace.h"

namespace tendril {

/// The bending of rods without twist state in a segment: the springs between two edges, with the energy of
/// each node in grad.energy when asked for. Fails where two edges fold back.
Evaluation hinge(const Model& model, const State& reference, const Model::Segment& segment, bool energy,
                 const Kinematics& kin, Gradient& grad);

}  // namespace tendril
