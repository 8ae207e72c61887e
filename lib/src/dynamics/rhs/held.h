#pragma once

#include "workspace.h"

namespace tendril {

/// Whether an edge at a held frame points straight against it, or has turned through that since the
/// reference: past half a turn its angle tells another way to bend.
bool past_half_turn(const Model& model, const State& reference, std::size_t node, const Kinematics& kin);

/// The springs between the edges at a node and its held frame, of a rod without twist: 1/2 K angle^2 each, up
/// to half a turn. What they give the edges goes to g_before and g_after. Returns the energy.
double bend_at_held_hinge(const Model& model, std::size_t node, const Kinematics& kin, Gradient& grad);

/// The same for a rod with twist, the angle split into those about the frame's two axes; adds what the frame
/// feels. With `viscous` each but the third resists.
/// \param after  angles of the edge after the node, where they are known; else null
double bend_at_held_frame(const Model& model, std::size_t node, bool viscous, const EdgeAngles* after,
                          const Kinematics& kin, Gradient& grad, double& heat);

/// At the nodes where rods are joined: lets the twist springs of the children's first edges give way, once
/// the loops have filled them, and says by grad.given how much their bending does. Returns what that adds to
/// the energy, -1/2 T.omega. The energy is least at omega, so that its gradient is that with omega held
/// still. What resists does not give way.
/// \param viscous  the loops' torques have their viscous part
double give_way_at_hubs(const Model& model, bool viscous, const Kinematics& kin, Gradient& grad);

}  // namespace tendril
