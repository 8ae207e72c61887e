#pragma once

#include "dynamics/scene/model.h"
#include "dynamics/vector/columns.h"

namespace tendril {

/// Scratch columns of one evaluation, one entry per node (edges by their first node). The edge entry of a
/// rod's last node belongs to no edge: it is kept at 0, so that loops need not know where rods end.
class System::Workspace {
 public:
  explicit Workspace(const Model& model);

  std::vector<AnchorPose> pose;  ///< per anchor

  // Kinematics: positions, edges, frames, and their rates.
  Columns3 p, v, e, e_rate;
  Columns3 turning;  ///< of the tangents, t x t'
  FrameColumns frame;
  Column length, inverse_length, length_rate;
  Column inverse_bisector;  ///< of the unit edges' sum; 0 where the frame is held
  Column spin, connection;

  // Gradients of the energy (with the viscous part where asked for): by the unit edges, as the springs at
  // their two nodes give it and as the tangents pass it on, by the tangents and by the spins.
  Columns3 g_bend;             ///< by the edge after a free node, minus that by the edge before
  Columns3 g_before, g_after;  ///< by the edges at a held frame; elsewhere they stay 0
  Columns3 g_tangent;          ///< across the tangent
  Column g_spin, g_length;
  Columns3 twist_tangent;  ///< per edge: what its twist spring gives either tangent
  Column twist_torque;     ///< per edge
  Column energy, heat;     ///< per edge or node, of one kind of springs at a time

  Columns3 edge_force, force;

  // What forces other than gravity see and give; empty without them.
  std::vector<Vec3> seen_p, seen_v, seen_t, seen_m, load, torque;
  std::vector<double> seen_spin;

  Vec3 t_rate(std::size_t i) const { return Vec3(turning[i]).cross(Vec3(frame.z[i])); }
};

}  // namespace tendril
