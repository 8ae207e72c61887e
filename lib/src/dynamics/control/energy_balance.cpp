#include "energy_balance.h"

#include <algorithm>
#include <cmath>

namespace tendril {

EnergyBalance::EnergyBalance(const System& system, System::Workspace& work, const State& state)
    : system_(system),
      workspace_(work),
      first_(system.energies(state, work)),
      last_(first_),
      work_before_(-state.y[state.y.size() - 1]) {}

void EnergyBalance::take_over(const EnergyBalance& before) {
  work_before_ = before.work_before_ + (last_.total() - before.last_.total());
  first_ = before.first_;
  scale_at_least(before.scale_);
}

double EnergyBalance::change(const State& before, const State& after) {
  const auto kept = [&](const State& state) {
    return system_.energies(state, workspace_).total() - state.y[state.y.size() - 1];
  };
  const double put_in = kept(after) - kept(before);
  work_before_ += put_in;
  look(after);
  return put_in;
}

void EnergyBalance::look(const State& state) {
  last_ = system_.energies(state, workspace_);
  const double done = work(state);
  scale_at_least(last_.kinetic + std::abs(last_.elastic - first_.elastic) +
                 std::abs(last_.potential - first_.potential) + std::abs(done));
  imbalance_ = scale_ > 0.0 ? (last_.total() - first_.total() - done) / scale_ : 0.0;
}

}  // namespace tendril
