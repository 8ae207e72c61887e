#include "guard.h"

#include <tendril/dynamics/stability.h>

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

constexpr int kLanczosVectors = kFrequencyCost / 2;

}  // namespace

double fastest_motion(const System& system, const State& state, System::Workspace& work) {
  return system.largest_frequency(state, kLanczosVectors, work);
}

double longest_turn(const System& system, const State& state) {
  const auto k = 3 * static_cast<Eigen::Index>(system.body_count());
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < k; i += 3)
    fastest = std::max(fastest, state.y.segment<3>(state.y.size() - 1 - k + i).norm());
  return fastest > 0.0 ? 1.5 / fastest : std::numeric_limits<double>::infinity();
}

void Guard::measure(const State& state, double duration, const Growth& growth, System::Workspace& work) {
  since_.begin_anew();
  last_ = fastest_motion(system_, state, work);
  if (frequency_ && std::abs(last_ - *frequency_) <= 0.01 * *frequency_) return;
  frequency_ = last_;
  duration_ = duration;
  cap(growth);
}

double Guard::step_of(const Growth& growth) const {
  double alpha = std::numeric_limits<double>::infinity();
  double beta = alpha;
  double most_beta = 0.0;
  if (system_.body_count() > 0) alpha = beta = 0.0;
  for (const Rod& rod : system_.scene().rods) {
    alpha = std::min(alpha, rod.mass_damping);
    beta = std::min(beta, rod.viscosity);
    most_beta = std::max(most_beta, rod.viscosity);
  }
  const GuardLimits limits{options_.amplification, options_.total_amplification, duration_};
  // Where rods differ, the least damped decides on growth and the most viscous on the real axis.
  const double least = guard_step(*frequency_, alpha, beta, limits, growth);
  return most_beta > beta ? std::min(least, guard_step(*frequency_, alpha, most_beta, limits, growth))
                          : least;
}

}  // namespace tendril
