#include <algorithm>

#include "dynamics/rhs/kinematics.h"
#include "dynamics/rhs/rates.h"

namespace tendril {

bool System::remember(State& state, Workspace& work) const {
  const Model& model = *model_;
  const bool first = state.memory.empty();
  const auto asked = [&](const Model::Acting& acting) { return first || memory_of(acting, state); };
  if (std::none_of(model.acting.begin(), model.acting.end(), asked)) return false;
  if (!kinematics(model, state, state.time, state.y, Motion::all, work.kinematics).ok()) return false;
  state.memory.resize(model.scene.forces.size());
  StateView seen = view(model, state.time, work.kinematics, work.loads);
  bool anew = false;
  for (const Model::Acting& acting : model.acting) {
    std::shared_ptr<const ForceMemory>& kept = state.memory[acting.index];
    if (!first && !kept) continue;
    seen.memory = kept.get();
    std::shared_ptr<const ForceMemory> next = acting.force->remember(seen, kept);
    if (next == kept) continue;
    anew = true;
    if (kept && acting.has_energy) {
      const double before = acting.force->energy(seen);
      seen.memory = next.get();
      state.y[model.work_index()] += acting.force->energy(seen) - before;
    }
    kept = std::move(next);
  }
  return anew;
}

}  // namespace tendril
