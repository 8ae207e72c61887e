#include "energy_balance.h"

#include <algorithm>
#include <cmath>

#include "dynamics/scene/model.h"

namespace tendril {
namespace {

// Of all the energy there is, which the balance cannot tell from rounding.
constexpr double kRounding = 1e-9;

}  // namespace

EnergyBalance::EnergyBalance(const System& system, System::Workspace& work, const State& state)
    : system_(system),
      workspace_(work),
      free_(trees_of(model_of(system))),
      first_(system.energies(state, work)),
      last_(first_),
      laid_out_(first_),
      laid_out_work_(state.y[state.y.size() - 1]),
      work_before_(-laid_out_work_) {
  std::erase_if(free_, [](const Tree& tree) { return !tree.free; });
  laid_out_common_ = common_motion(state);
}

/// Its kinetic energy.
double EnergyBalance::common_motion(const State& state) const {
  const Model& model = model_of(system_);
  double sum = 0.0;
  for (const Tree& tree : free_) {
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (const std::size_t i : tree.nodes) {
      mass += model.mass[i];
      momentum += model.mass[i] * state.y.segment<3>(model.v_begin() + 3 * static_cast<Eigen::Index>(i));
    }
    sum += 0.5 * momentum.squaredNorm() / mass;
  }
  return sum;
}

void EnergyBalance::take_over(const EnergyBalance& before) {
  work_before_ = before.work_before_ + (last_.total() - before.last_.total());
  first_ = before.first_;
  scale_ = std::max(scale_, before.scale_);
  own_scale_ = std::max(own_scale_, before.own_scale_);
}

void EnergyBalance::scale_at_least(double energy, double own) {
  scale_ = std::max(scale_, energy);
  own_scale_ = std::max(own_scale_, own);
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

void EnergyBalance::look(const State& state, const Energies& energies) {
  last_ = energies;
  const double common = common_motion(state);
  const double sprung = std::abs(last_.elastic - laid_out_.elastic);
  const double came = state.y[state.y.size() - 1] - laid_out_work_ - (last_.potential - laid_out_.potential);
  const double fell = std::abs(last_.potential - laid_out_.potential);
  // What is stored from the start counts too: a scene at rest in its equilibrium has no other energy, and its
  // sum is no more exact than that.
  const double rounding =
      kRounding * (last_.kinetic + sprung + fell + std::abs(last_.elastic) + std::abs(last_.potential));
  own_scale_ = std::max(
      {own_scale_, rounding, last_.kinetic - common + sprung + std::abs(came - (common - laid_out_common_))});
  scale_ = std::max({scale_, rounding,
                     last_.kinetic + std::abs(last_.elastic - first_.elastic) +
                         std::abs(last_.potential - first_.potential) + std::abs(work(state))});
  off_ = off(state, last_);
  imbalance_ = scale_ > 0.0 ? off_ / scale_ : 0.0;
}

}  // namespace tendril
