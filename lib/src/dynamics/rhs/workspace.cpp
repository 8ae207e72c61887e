#include "workspace.h"

#include <utility>

namespace tendril {

System::Workspace::Workspace(const Model& model) : pose(model.anchors.size()) {
  const std::size_t n = model.nodes;
  std::size_t rank = 0;
  for (auto* vectors : {&p, &v, &frame.y, &frame.z, &e, &e_rate, &turning, &g_bend, &g_before, &g_after,
                        &g_tangent, &twist_tangent, &edge_force, &force})
    *vectors = Columns3(n, std::exchange(rank, rank + 3));
  for (auto* numbers : {&length, &inverse_length, &length_rate, &inverse_bisector, &spin, &connection,
                        &g_spin, &g_length, &twist_torque, &energy, &heat})
    *numbers = Column(n, rank++);
  if (!model.loaded) return;
  for (auto* vectors : {&seen_p, &seen_v, &seen_t, &seen_m, &load, &torque}) vectors->assign(n, Vec3::Zero());
  seen_spin.assign(n, 0.0);
}

}  // namespace tendril
