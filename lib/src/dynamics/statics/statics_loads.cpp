#include "statics_loads.h"

#include <algorithm>
#include <cmath>

#include "dynamics/coupling/coupled_nodes.h"

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
    forces_.push_back({&*acting++, Vec3::Zero()});
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

Evaluation StaticLoads::add(const State& state, Eigen::VectorXd& q, double& potential,
                            System::Workspace& work) {
  q.setZero(coordinates_.size());
  potential = sum_ = 0.0;
  if (!any()) return {};
  const std::vector<Frame> frames = system_.frames(state, work);
  if (frames.empty()) return {Evaluation::Outcome::not_finite, 0};
  StateView view = view_of(state, frames);
  std::size_t refused = Loads::kNone;
  Loads loads{force_, torque_};
  loads.refused = &refused;
  for (auto* vectors : {&force_, &torque_}) std::fill(vectors->begin(), vectors->end(), Vec3::Zero());
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

/// Greedy, by the nodes that springs and loads couple: two nodes of one colour share none of those.
void StaticLoads::colour(const Eigen::SparseMatrix<double>& pattern) {
  const std::size_t n = system_.node_count();
  near_.assign(n, {});
  for (Eigen::Index column = 0; column < 3 * static_cast<Eigen::Index>(n); column += 3)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(pattern, column); entry; ++entry)
      if (entry.row() < 3 * static_cast<Eigen::Index>(n) && entry.row() % 3 == 0)
        near_[static_cast<std::size_t>(column / 3)].push_back(static_cast<std::size_t>(entry.row() / 3));
  for (const Model::Acting& acting : model_of(system_).acting)
    for (const auto& [a, b] : coupled_by_force(model_of(system_), acting.couplings, true))
      for (const auto& [to, from] : {std::pair(a, b), std::pair(b, a)})
        if (auto& list = near_[to]; std::find(list.begin(), list.end(), from) == list.end())
          list.push_back(from);
  std::vector<std::size_t> colour_of(n, n);
  std::vector<std::size_t> seen(n + 1, n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t j : near_[i])
      for (const std::size_t k : near_[j]) seen[colour_of[k]] = i;
    std::size_t colour = 0;
    while (seen[colour] == i) ++colour;
    colour_of[i] = colour;
    if (colour == colours_.size()) colours_.emplace_back();
    colours_[colour].push_back(i);
  }
}

Evaluation StaticLoads::moved(const State& state, const Eigen::VectorXd& x, Eigen::VectorXd& q,
                              System::Workspace& work) {
  State there = state;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const Eigen::Index place = coordinates_.in_gradient(k);
    const auto n = static_cast<Eigen::Index>(system_.node_count());
    const std::size_t node = coordinates_.node(k);
    if (const Mat3* axes = coordinates_.axes(node); axes && coordinates_.axis(k) < 3)
      there.y.segment<3>(3 * static_cast<Eigen::Index>(node)) += x[k] * axes->col(coordinates_.axis(k));
    else
      there.y[coordinates_.axis(k) == 3 ? place + 3 * n : place] += x[k];
  }
  double unused = 0.0;
  return add(there, q, unused, work);
}

Evaluation StaticLoads::differentiate(const State& state, const Eigen::SparseMatrix<double>& pattern,
                                      std::vector<Eigen::Triplet<double>>& out, System::Workspace& work) {
  if (colours_.empty()) colour(pattern);
  const double edge = coordinates_.length() / static_cast<double>(system_.node_count());
  Eigen::VectorXd up, down;
  for (const auto& nodes : colours_)
    for (int axis = 0; axis < 4; ++axis) {
      const double step = 1e-6 * (axis == 3 ? 1.0 : edge);
      Eigen::VectorXd x = Eigen::VectorXd::Zero(coordinates_.size());
      bool any = false;
      for (const std::size_t i : nodes)
        if (const Eigen::Index k = coordinates_.row(i, axis); k >= 0) x[k] = step, any = true;
      if (!any) continue;
      if (const Evaluation at = moved(state, x, up, work); !at.ok()) return at;
      if (const Evaluation at = moved(state, -x, down, work); !at.ok()) return at;
      for (const std::size_t i : nodes) {
        const Eigen::Index column = coordinates_.row(i, axis);
        if (column < 0) continue;
        for (const std::size_t j : near_[i])
          for (int b = 0; b < 4; ++b)
            if (const Eigen::Index r = coordinates_.row(j, b); r >= 0 && up[r] != down[r])
              out.emplace_back(r, column, (up[r] - down[r]) / (2 * step));
      }
    }
  return {};
}

}  // namespace tendril
