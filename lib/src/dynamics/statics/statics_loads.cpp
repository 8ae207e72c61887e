#include "statics_loads.h"

#include <algorithm>
#include <cmath>

namespace tendril {
namespace {

Vec3 across(const Vec3& n, const Vec3& v) {
  return v - n.dot(v) * n;
}

}  // namespace

StaticLoads::StaticLoads(const System& system, const StaticCoordinates& coordinates)
    : system_(system), coordinates_(coordinates) {
  for (const Rod& rod : system.scene().rods) {
    mass_.insert(mass_.end(), rod.mass.begin(), rod.mass.end());
    width_.insert(width_.end(), rod.width.begin(), rod.width.end());
    width_.push_back(0.0);
  }
  auto acting = model_of(system).acting.begin();
  for (const auto& force : system.scene().forces) {
    if (const std::optional<Vec3> a = force->uniform_acceleration()) {
      forces_.push_back({nullptr, *a});
      continue;
    }
    conservative_ = conservative_ && (acting->has_energy || !acting->couplings.any());
    depends_on_state_ = depends_on_state_ || acting->couplings.any();
    const bool alike = !acting->varies() && !acting->couplings.derivatives();
    forces_.push_back({&*acting, Vec3::Zero(),
                       alike ? coupled_by_force(model_of(system), acting->couplings, true) : NodePairs{}});
    ++acting;
  }
  const std::size_t n = system.node_count();
  spin_.assign(n, 0.0);
  for (auto* vectors : {&p_, &v_, &t_, &m_, &force_, &torque_}) vectors->assign(n, Vec3::Zero());
}

StateView StaticLoads::view_of(const State& state, const std::vector<Frame>& frames) {
  for (std::size_t i = 0; i < p_.size(); ++i) {
    p_[i] = at(state.y, i);
    t_[i] = frames[i].z;
    m_[i] = frames[i].y;
  }
  // Nothing moves: turns are as the velocities, zeros.
  return {state.time, p_, v_, t_, spin_, mass_, width_, system_.rods(), m_, nullptr, {}, v_};
}

/// All zero, to be added to.
Loads StaticLoads::no_loads(std::size_t* refused) {
  for (auto* vectors : {&force_, &torque_}) std::fill(vectors->begin(), vectors->end(), Vec3::Zero());
  return {force_, torque_, refused};
}

Evaluation StaticLoads::add(const State& state, Eigen::VectorXd& q, double& potential,
                            System::Workspace& work) {
  q.setZero(coordinates_.size());
  potential = sum_ = 0.0;
  if (!any()) return {};
  const std::vector<Frame> frames = system_.frames(state, work);
  if (frames.empty()) return {Evaluation::Outcome::not_finite, 0};
  StateView view = view_of(state, frames);
  std::size_t refused = Loads::kNone;
  const Loads loads = no_loads(&refused);
  for (const External& one : forces_) {
    if (!one.dead()) continue;
    view.memory = memory_of(*one.acting, state);
    one.acting->force->add(view, loads);
  }
  for (std::size_t i = 0; i < p_.size(); ++i) potential -= force_[i].dot(p_[i]);
  for (const External& one : forces_)
    if (!one.dead()) add_living(one, state, view, loads, potential);
  if (refused != Loads::kNone) return {Evaluation::Outcome::refused, refused};
  for (std::size_t i = 0; i < p_.size(); ++i)
    sum_ += force_[i].norm() + torque_[i].norm() / coordinates_.length();
  pass_to_parents();
  pull_back(frames, q);
  return q.allFinite() && std::isfinite(potential) ? Evaluation{}
                                                   : Evaluation{Evaluation::Outcome::not_finite, 0};
}

void StaticLoads::add_living(const External& one, const State& state, StateView& view, const Loads& loads,
                             double& potential) const {
  if (one.acting) {
    view.memory = memory_of(*one.acting, state);
    if (one.acting->has_energy) potential += one.acting->force->energy(view);
    one.acting->force->add(view, loads);
    return;
  }
  double energy = 0.0;
  for (std::size_t i = 0; i < p_.size(); ++i) {
    energy -= mass_[i] * one.acceleration.dot(p_[i]);
    loads.force[i] += mass_[i] * one.acceleration;
  }
  potential += energy;
}

void StaticLoads::pass_to_parents() {
  for (const std::size_t r : coordinates_.children_first()) {
    if (coordinates_.parent_node(r) < 0 || !coordinates_.reacts(r)) continue;
    const auto parent = static_cast<std::size_t>(coordinates_.parent_node(r));
    const std::size_t root = system_.rods()[r].first;
    force_[parent] += force_[root];
    torque_[parent] += torque_[root];
  }
}

void StaticLoads::pull_back(const std::vector<Frame>& frames, Eigen::VectorXd& q) {
  for (const NodeRange& rod : system_.rods())
    for (std::size_t i = rod.first; i < rod.first + rod.count; ++i)
      if (!coordinates_.holds_frame(i) && !torque_[i].isZero(0.0))
        pull_back_turn(rod, i, torque_[i].cross(frames[i].z));
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const std::size_t i = coordinates_.node(k);
    const int axis = coordinates_.axis(k);
    const Model::Swivel* swivel = axis == 3 ? model_of(system_).swivel_of(i) : nullptr;
    q[k] = swivel      ? torque_[i].dot(swivel->of(frames[i]))
           : axis == 3 ? torque_[i].dot(frames[i].z)
                       : coordinates_.along(i, axis, force_[i]);
  }
}

/// The tangent is the unit sum of the unit edges around. What the root of a child feels, its parent's node
/// does.
void StaticLoads::pull_back_turn(const NodeRange& rod, std::size_t node, const Vec3& by_tangent) {
  const auto edge = [&](std::size_t i) { return Vec3(p_[i + 1] - p_[i]); };
  const Model& model = model_of(system_);
  const std::size_t from = node > rod.first ? node - 1 : node;
  const std::size_t to = node + 1 < rod.first + rod.count ? node + 1 : node;
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = from; i < to; ++i) sum += edge(i).normalized();
  const Vec3 by_edges = across(t_[node], by_tangent) / sum.norm();
  for (std::size_t i = from; i < to; ++i) {
    const Vec3 f = across(edge(i).normalized(), by_edges) / edge(i).norm();
    force_[i + 1] += f;
    if (model.feels[i]) force_[model.carrier[i]] -= f;
  }
}

}  // namespace tendril
