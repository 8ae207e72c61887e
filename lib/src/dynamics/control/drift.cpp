#include "drift.h"

#include <algorithm>
#include <cmath>

#include "dynamics/scene/model.h"

namespace tendril {
namespace {

double longest_rod(const Model& model, const Tree& tree) {
  double longest = 0.0;
  double length = 0.0;
  for (const std::size_t i : tree.nodes) {
    if (!model.has_before(i)) length = 0.0;
    if (model.has_after(i)) length += model.rest_length[i];
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace

/// How a tree moves in itself: about its centre where nothing holds it.
struct Drift::Motion {
  double speed = 0.0, way = 0.0;  ///< largest of its nodes
  Vec3 turning = Vec3::Zero();
  double most_turning = 0.0;  ///< were all of it one way
};

Drift::Drift(const System& system, const State& state)
    : system_(system),
      trees_(trees_of(model_of(system))),
      start_(state.y),
      time_(state.time),
      untouched_(!model_of(system).loaded && !model_of(system).damped) {
  for (const Tree& tree : trees_) moved_.push_back({.length = longest_rod(model_of(system), tree)});
  begin_anew(state);
}

void Drift::begin_anew(const State& state) {
  for (std::size_t b = 0; b < trees_.size(); ++b) moved_[b].turning = motion(trees_[b], state).turning;
}

void Drift::take_over(const Drift& before) {
  for (std::size_t b = 0; b < moved_.size() && b < before.moved_.size(); ++b) {
    moved_[b].by_energy = before.moved_[b].by_energy;
    moved_[b].by_turning = before.moved_[b].by_turning;
    moved_[b].way = before.moved_[b].way;
  }
  fastest_ = before.fastest_;
}

Drift::Motion Drift::motion(const Tree& tree, const State& state) const {
  const Model& model = model_of(system_);
  const auto at = [](std::size_t i) { return 3 * static_cast<Eigen::Index>(i); };
  const auto place = [&](const Eigen::VectorXd& y, std::size_t i) { return Vec3(y.segment<3>(at(i))); };
  const auto velocity = [&](std::size_t i) { return Vec3(state.y.segment<3>(model.v_begin() + at(i))); };
  Vec3 from = Vec3::Zero(), now = Vec3::Zero(), common = Vec3::Zero();
  if (tree.free) {
    double mass = 0.0;
    for (const std::size_t i : tree.nodes) {
      mass += model.mass[i];
      from += model.mass[i] * place(start_, i);
      now += model.mass[i] * place(state.y, i);
      common += model.mass[i] * velocity(i);
    }
    from /= mass, now /= mass, common /= mass;
  }
  Motion result;
  for (const std::size_t i : tree.nodes) {
    const Vec3 arm = place(state.y, i) - now;
    const Vec3 v = velocity(i) - common;
    result.speed = std::max(result.speed, v.squaredNorm());
    result.way = std::max(result.way, (arm - (place(start_, i) - from)).squaredNorm());
    result.turning += model.mass[i] * arm.cross(v);
    result.most_turning += model.mass[i] * arm.norm() * v.norm();
    if (!model.has_twist(i) || model.holds_frame(i)) continue;
    const double spin = model.inertia[i] * state.y[model.spin_begin() + model.twist_index[i]];
    result.turning += spin * state.tangent[i];
    result.most_turning += std::abs(spin);
  }
  result.speed = std::sqrt(result.speed);
  result.way = std::sqrt(result.way);
  return result;
}

void Drift::look(const State& state, double imbalance) {
  const double passed = state.time - time_;
  time_ = state.time;
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    Moved& moved = moved_[b];
    const Motion now = motion(trees_[b], state);
    const double rate = now.speed / moved.length;
    fastest_ = std::max(fastest_, rate);
    moved.way = std::max(moved.way, now.way / moved.length);
    moved.most_turning = std::max(moved.most_turning, now.most_turning);
    moved.by_energy += 0.5 * std::abs(imbalance) * rate * passed;
    if (trees_[b].free && untouched_ && moved.most_turning > 0.0)
      moved.by_turning += (now.turning - moved.turning).norm() / moved.most_turning * rate * passed;
  }
}

double Drift::lag() const {
  double most = 0.0;
  for (const Moved& moved : moved_) most = std::max(most, moved.lag());
  return most;
}

bool Drift::by_turning() const {
  double most = 0.0;
  bool result = false;
  for (const Moved& moved : moved_) {
    if (!(moved.lag() > most)) continue;
    most = moved.lag();
    result = moved.by_turning > 1.5 * moved.by_energy;
  }
  return result;
}

double Drift::widest() const {
  double most = 0.0;
  for (const Moved& moved : moved_) most = std::max(most, moved.way);
  return most;
}

}  // namespace tendril
