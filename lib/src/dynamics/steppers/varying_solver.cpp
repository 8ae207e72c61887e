#include <tendril/base/error.h>

#include <algorithm>

#include "dynamics/coupling/elimination.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/scene/words.h"
#include "local_forces.h"

namespace tendril {
namespace {

void sort_once(NodePairs& pairs) {
  for (auto& [a, b] : pairs)
    if (a > b) std::swap(a, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Of what touches, pairs come and go from step to step, and each new pattern costs about as much as an
/// elimination: one that has more than is needed serves on, until it has more than twice that.
bool serves(const NodePairs& kept, const NodePairs& needed) {
  return kept.size() <= 2 * needed.size() + 8 &&
         std::includes(kept.begin(), kept.end(), needed.begin(), needed.end());
}

/// A solver for what couples at a state, asked for anew at each.
class VaryingSolver : public StiffSolver {
 public:
  VaryingSolver(const System& system, System::Workspace& work)
      : system_(system), model_(model_of(system)), work_(work) {
    for (const Model::Acting& acting : model_.acting)
      differs_ = differs_ || (acting.varies() && acting.by_differences());
  }

  long differentiate(const State& state, const Eigen::VectorXd& rate) override {
    if (fails(look(state))) return -1;
    if (!solver_ || !serves(local_.pairs, pairs_)) {
      // Without what is no longer needed, and with what was a step ago.
      local_.pairs = pairs_;
      local_.pairs.insert(local_.pairs.end(), before_.begin(), before_.end());
      sort_once(local_.pairs);
      if (fails(make())) return -1;
    }
    before_.swap(pairs_);
    const long cost = solver_->differentiate(state, rate);
    if (cost < 0) {
      fails(solver_->failure());
      return -1;
    }
    by_time_ = solver_->by_time();
    return cost + 1;
  }

  bool factor(double s) override { return solver_->factor(s); }
  void solve(double s, const Eigen::VectorXd& r, Eigen::VectorXd& result) override {
    solver_->solve(s, r, result);
  }

 private:
  /// Asks the forces for what acts here.
  Evaluation look(const State& state) {
    Kinematics& kin = work_.kinematics;
    if (const Evaluation at = kinematics(model_, state, state.time, state.y, Motion::all, kin); !at.ok())
      return at;
    StateView seen = view(model_, state.time, kin, work_.loads);
    local_.undifferentiated.clear();
    pairs_.clear();
    for (const Model::Acting& acting : model_.acting) {
      if (!acting.varies()) continue;
      seen.memory = memory_of(acting, state);
      LocalCouplings local = acting.couplings.local()(seen);
      check(acting, local);
      const NodePairs more = coupled_by_pairs(model_, local.pairs, acting.by_differences());
      pairs_.insert(pairs_.end(), more.begin(), more.end());
      if (acting.by_differences() && !local.pairs.empty())
        local_.undifferentiated.push_back({&acting, std::move(local.add)});
    }
    sort_once(pairs_);
    return {};
  }

  void check(const Model::Acting& acting, const LocalCouplings& local) const {
    for (const auto& [a, b] : local.pairs)
      if (std::max(a, b) >= model_.index_count())
        throw InvalidInput(name_of_force(acting.index),
                           sentence("couples node ", std::max(a, b), " at a state"),
                           sentence("flat indices less than ", model_.index_count()));
  }

  Evaluation make() {
    solver_.reset();
    local_.pattern = pattern_of_equations(model_, local_.pairs);
    if (!local_.pattern->complete())
      return {Evaluation::Outcome::coupled_too_far, local_.pairs.front().first};
    local_.neighbours.clear();
    if (differs_) {
      local_.neighbours.resize(model_.index_count());
      const auto add = [&](std::size_t i, std::size_t j) {
        if (local_.neighbours[i].empty()) local_.neighbours[i].push_back(i);
        if (i != j) local_.neighbours[i].push_back(j);
      };
      for (const auto& [i, j] : local_.pairs) {
        add(i, j);
        add(j, i);
      }
    }
    solver_ = make_block_solver(system_, work_, &local_);
    return {};
  }

  const System& system_;
  const Model& model_;
  System::Workspace& work_;
  bool differs_ = false;  ///< some need differences
  LocalForces local_;
  NodePairs pairs_, before_;  ///< at the state of now, and that of before
  std::unique_ptr<StiffSolver> solver_;
};

}  // namespace

std::unique_ptr<StiffSolver> make_stiff_solver(const System& system, System::Workspace& work) {
  for (const Model::Acting& acting : model_of(system).acting)
    if (acting.varies()) return std::make_unique<VaryingSolver>(system, work);
  return make_block_solver(system, work, nullptr);
}

}  // namespace tendril
