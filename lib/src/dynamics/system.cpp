#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>

#include "elastic.h"

namespace tendril {
namespace {

using Outcome = Evaluation::Outcome;
using Workspace = System::Workspace;
using Model = System::Model;

StateView view(const Model& model, double t, Workspace& work) {
  for (std::size_t i = 0; i < model.nodes; ++i) work.tangent[i] = work.frame[i].z;
  return {t, work.p, work.v, work.tangent, work.spin, model.mass, model.width, model.rods};
}

/// Adds all external forces; returns the power of those without an energy.
double add_external(const Model& model, double t, Workspace& work) {
  const StateView state = view(model, t, work);
  const Loads loads{work.force, work.torque};
  for (const auto& force : model.scene.forces)
    if (!force->has_energy()) force->add(state, loads);
  double power = 0.0;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const Vec3 turning = work.tangent[i].cross(work.t_rate[i]) + work.spin[i] * work.tangent[i];
    power += work.force[i].dot(work.v[i]) + work.torque[i].dot(turning);
  }
  for (const auto& force : model.scene.forces)
    if (force->has_energy()) force->add(state, loads);
  return power;
}

/// Torques across the tangent and the gyroscopic force of the spin act through the tangent; see
/// add_pulled_back.
void add_turning(const Model& model, Workspace& work) {
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const Vec3& t = work.frame[i].z;
    work.g_tangent[i] -= work.torque[i].cross(t);
    if (model.has_twist(i) && !model.holds_frame(i))
      work.g_tangent[i] -= model.inertia[i] * work.spin[i] * t.cross(work.t_rate[i]);
  }
}

/// Power that anchors put in: against the whole force on a held position and the whole torque on a held
/// frame.
double anchor_power(const Model& model, const Workspace& work) {
  double power = 0.0;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (model.holds_frame(i))
      power += work.g_tangent[i].dot(work.t_rate[i]) +
               (work.g_spin[i] - work.torque[i].dot(work.frame[i].z)) * work.spin[i];
    if (model.holds_position(i)) power -= work.force[i].dot(work.v[i]);
  }
  return power;
}

}  // namespace

System::System(Scene scene) : model_(std::make_unique<const Model>(std::move(scene))) {}
System::~System() = default;
System::System(System&&) noexcept = default;
System& System::operator=(System&&) noexcept = default;

System::WorkspacePtr System::make_workspace() const {
  return WorkspacePtr(new Workspace(*model_));
}

void System::Release::operator()(Workspace* work) const {
  delete work;
}

std::span<const NodeRange> System::rods() const {
  return model_->rods;
}
std::size_t System::node_count() const {
  return model_->nodes;
}
std::size_t System::twist_count() const {
  return model_->twist_nodes;
}
const Scene& System::scene() const {
  return model_->scene;
}
const std::vector<std::string>& System::left_out() const {
  return model_->left_out;
}

State System::rest_state(double time) const {
  State state;
  state.time = time;
  state.y = Eigen::VectorXd::Zero(model_->size());
  for (std::size_t i = 0; i < model_->nodes; ++i) {
    state.y.segment<3>(3 * static_cast<Eigen::Index>(i)) = model_->rest_p[i];
    state.tangent.push_back(model_->rest_frame[i].z);
    state.director.push_back(model_->rest_frame[i].y);
  }
  state.twist = model_->rest_twist;
  const auto work = make_workspace();
  if (!rebase(state, *work).ok())
    throw InvalidInput("anchors", "the poses at the start leave no frame at some node",
                       "poses near the rest shape");
  return state;
}

Evaluation rates(const Model& model, const State& reference, double t, const Eigen::VectorXd& y, bool springs,
                 Eigen::VectorXd& dy, Workspace& work) {
  if (const Evaluation at = kinematics(model, reference, t, y, true, work); !at.ok()) return at;
  double dissipated = 0.0;
  if (springs)
    elastic(model, reference, true, work, dissipated);
  else
    relax(work);
  std::fill(work.force.begin(), work.force.end(), Vec3::Zero());
  std::fill(work.torque.begin(), work.torque.end(), Vec3::Zero());
  double power = add_external(model, t, work) - dissipated;
  add_turning(model, work);
  add_pulled_back(model, work);
  power += anchor_power(model, work);

  dy.resize(model.size());
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const bool held = model.holds_position(i);
    dy.segment<3>(at) = held ? Vec3(Vec3::Zero()) : work.v[i];
    dy.segment<3>(model.v_begin() + at) =
        held ? Vec3(Vec3::Zero()) : Vec3(work.force[i] / model.moved_mass[i] - model.damping[i] * work.v[i]);
    if (!held) power -= model.damping[i] * model.moved_mass[i] * work.v[i].squaredNorm();
    if (!model.has_twist(i)) continue;
    const Eigen::Index k = model.twist_index[i];
    const bool turned = model.holds_frame(i);
    const double torque = work.torque[i].dot(work.frame[i].z) - work.g_spin[i];
    dy[model.theta_begin() + k] = turned ? 0.0 : work.spin[i] + work.connection[i];
    dy[model.spin_begin() + k] = turned ? 0.0 : torque / model.inertia[i] - model.damping[i] * work.spin[i];
    if (!turned) power -= model.damping[i] * model.inertia[i] * work.spin[i] * work.spin[i];
  }
  dy[model.work_index()] = power;
  return dy.allFinite() ? Evaluation{} : Evaluation{Outcome::not_finite, 0};
}

Evaluation System::derivative(const State& reference, double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy,
                              Workspace& work) const {
  return rates(*model_, reference, t, y, true, dy, work);
}

Evaluation System::elastic_gradient(const State& reference, double t, const Eigen::VectorXd& y,
                                    double& energy, Eigen::VectorXd& gradient, Workspace& work) const {
  const Model& model = *model_;
  if (const Evaluation at = kinematics(model, reference, t, y, false, work); !at.ok()) return at;
  double dissipated = 0.0;
  energy = elastic(model, reference, false, work, dissipated);
  std::fill(work.force.begin(), work.force.end(), Vec3::Zero());
  std::fill(work.torque.begin(), work.torque.end(), Vec3::Zero());
  add_pulled_back(model, work);
  gradient.resize(model.v_begin() + static_cast<Eigen::Index>(model.twist_nodes));
  for (std::size_t i = 0; i < model.nodes; ++i) {
    gradient.segment<3>(3 * static_cast<Eigen::Index>(i)) = -work.force[i];
    if (model.has_twist(i)) gradient[model.v_begin() + model.twist_index[i]] = work.g_spin[i];
  }
  return {};
}

Energies System::energies(const State& state, Workspace& work) const {
  const Model& model = *model_;
  Energies result;
  if (!kinematics(model, state, state.time, state.y, true, work).ok()) return result;
  double dissipated = 0.0;
  result.elastic = elastic(model, state, false, work, dissipated);
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (!model.holds_position(i)) result.kinetic += 0.5 * model.moved_mass[i] * work.v[i].squaredNorm();
    if (model.has_twist(i) && !model.holds_frame(i))
      result.kinetic += 0.5 * model.inertia[i] * work.spin[i] * work.spin[i];
  }
  const StateView seen = view(model, state.time, work);
  for (const auto& force : model.scene.forces)
    if (force->has_energy()) result.potential += force->energy(seen);
  return result;
}

}  // namespace tendril
