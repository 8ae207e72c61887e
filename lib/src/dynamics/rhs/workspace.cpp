#include "workspace.h"

#include <utility>

namespace tendril {

System::Workspace::Workspace(const System::Model& model) {
  const std::size_t n = model.nodes;
  Kinematics& k = kinematics;
  Gradient& g = gradient;
  k.pose.resize(model.anchors.size());
  k.bodies.resize(model.bodies.size());
  k.swivel_spin.assign(model.swivels.size(), 0.0);
  g.child_edges.resize(model.hub_children);
  g.swivel.assign(model.swivels.size(), Vec3::Zero());
  loads.on_bodies.resize(model.bodies.size());
  // Columns that a loop walks along side by side get neighbouring ranks.
  std::size_t rank = 0;
  for (auto* vectors :
       {&k.p, &k.v, &k.frame.y, &k.frame.z, &k.e, &k.rate.e_rate, &k.rate.turning, &g.bend, &g.before,
        &g.after, &g.tangent, &g.twist_tangent, &pull.edge_force, &pull.force, &g.given})
    *vectors = Columns3(n, std::exchange(rank, rank + 3));
  for (auto* numbers :
       {&k.length, &k.inverse_length, &k.rate.length_rate, &k.inverse_bisector, &k.spin, &k.rate.connection,
        &g.spin, &g.length, &g.twist_torque, &g.twist_strain, &g.energy, &g.heat})
    *numbers = Column(n, rank++);
  if (!model.loaded) return;
  for (auto* vectors : {&loads.p, &loads.v, &loads.load}) vectors->assign(n, Vec3::Zero());
  if (!model.acts_on_frames) return;
  for (auto* vectors : {&loads.t, &loads.m, &loads.turn, &loads.torque}) vectors->assign(n, Vec3::Zero());
  loads.spin.assign(n, 0.0);
}

}  // namespace tendril
