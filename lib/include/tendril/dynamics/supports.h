#pragma once

#include <tendril/base/export.h>
#include <tendril/dynamics/system.h>

#include <vector>

namespace tendril {

/// What an anchor does to the node that it holds, in the world's axes.
struct Support {
  Vec3 force = Vec3::Zero();   ///< on the node; 0 along what the anchor leaves free
  Vec3 torque = Vec3::Zero();  ///< on the node's frame, about the node; 0 where the anchor holds no frame
};

/// What each anchor of the scene does to its node at a state of motion: all that springs, loads and gravity
/// do not, so that momentum and angular momentum about any point change by their forces and torques and those
/// of the loads. With m the node's mass and I its spin inertia, a and w the pose's acceleration and spin
/// about the tangent t, F and T all other forces and torques there,
///
///     force = m a - F,    torque = d(I w t)/dt - T.
///
/// a and d(I w t)/dt come from the pose's velocities by a one-sided difference of second order over 1e-5 of
/// the anchor's period (of the time, where it has none), as they are just after the state's time. Damping
/// acts on what is free alone. Where a child feels its parent and the parent does not feel the child
/// (Joint::reaction), the child pulls at nothing.
///
/// \param system  may be laid out as of an earlier time: anchors that let go by the state's time do nothing
/// \param state   its own reference, as Simulation::state is
/// \return  per anchor of the scene; empty where the equations cannot be evaluated at the state
///
/// Cost: one evaluation of the equations and a workspace; a system, where anchors let go between.
TENDRIL_CORE_API std::vector<Support> supports_of(const System& system, const State& state);

}  // namespace tendril
