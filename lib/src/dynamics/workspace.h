#pragma once

#include "model.h"

namespace tendril {

/// Scratch arrays of one evaluation, one entry per node (edges by their first node).
class System::Workspace {
 public:
  explicit Workspace(const Model& model);

  std::vector<AnchorPose> pose;  ///< per anchor

  // Kinematics: positions, edges, frames, and their rates.
  std::vector<Vec3> p, v, e, e_rate, t_rate;
  std::vector<Frame> frame;
  std::vector<double> length, length_rate, bisector, spin, connection;

  // Gradients of the energy (with the viscous part where asked for).
  std::vector<Vec3> g_edge, g_tangent;
  std::vector<double> g_length, g_spin;

  std::vector<Vec3> force, torque;
  std::vector<Vec3> tangent;  ///< of the frames, for the forces' view
};

}  // namespace tendril
