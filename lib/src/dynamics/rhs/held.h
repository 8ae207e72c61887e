#pragma once

#include "workspace.h"

namespace tendril {

/// The springs between the edges at a node and its held frame, of a rod without twist: 1/2 K angle^2 each.
/// What they give the edges goes to g_before and g_after. Returns the energy.
double bend_at_held_hinge(const Model& model, std::size_t node, const Kinematics& kin, Gradient& grad);

/// The same for a rod with twist; adds what the frame feels. With `viscous` each but the third resists.
double bend_at_held_frame(const Model& model, std::size_t node, bool viscous, const Kinematics& kin,
                          Gradient& grad, double& heat);

}  // namespace tendril
