#include <tendril/dynamics/supports.h>

#include <algorithm>
#include <cmath>

#include "dynamics/rhs/workspace.h"

namespace tendril {
namespace {

constexpr double kStep = 1e-5;      // of the difference, over the period or the time
constexpr double kEarliest = 1e-3;  // time that counts as one

/// d f / dt just after t, of a vector f of the pose.
template <class F>
Vec3 rate_of(const Anchor& anchor, double t, const F& f) {
  if (!anchor.motion) return Vec3::Zero();
  const double h = kStep * (std::isfinite(anchor.period) ? anchor.period : std::max(kEarliest, std::abs(t)));
  const auto at = [&](double time) { return Vec3(f(anchor.motion(time))); };
  return (4.0 * at(t + h) - 3.0 * at(t) - at(t + 2.0 * h)) / (2.0 * h);
}

Vec3 force_on(const Model& model, const Anchor& anchor, std::size_t i, double t, const Pull& pull) {
  const Vec3 a = rate_of(anchor, t, [](const AnchorPose& pose) { return pose.velocity; });
  return model.moved_mass[i] * (a - model.gravity) - pull.force[i];
}

/// By the gradient after its pull-back: there torques across the tangent are in that by the tangent.
Vec3 torque_on(const Model& model, const Anchor& anchor, std::size_t i, double t,
               const System::Workspace& work) {
  const double inertia = model.has_twist(i) ? model.inertia[i] : 0.0;
  const Vec3 turned = rate_of(anchor, t, [inertia](const AnchorPose& pose) {
    return Vec3(inertia * pose.angular_velocity.dot(pose.frame.z) * pose.frame.z);
  });
  const Vec3 tangent = work.kinematics.frame.z[i];
  double along = model.has_twist(i) ? work.gradient.spin[i] : 0.0;
  if (model.acts_on_frames) along -= work.loads.torque[i].dot(tangent);
  return turned + tangent.cross(work.gradient.tangent[i]) + along * tangent;
}

/// What springs, loads and the axis's own turning ask for across it.
Vec3 torque_on_swivel(const Model& model, std::size_t k, const System::Workspace& work) {
  const Model::Swivel& swivel = model.swivels[k];
  const Kinematics& kin = work.kinematics;
  const Vec3 axis = swivel.of(kin.frame[swivel.node]);
  const Vec3 torque = work.gradient.swivel[k];
  const double momentum = model.inertia[swivel.node] * kin.swivel_spin[k];
  return torque - torque.dot(axis) * axis + momentum * kin.pose[swivel.anchor].angular_velocity.cross(axis);
}

}  // namespace

std::vector<Support> supports_of(const System& system, const State& state) {
  const Model& model = model_of(system);
  const auto lets_go = [&](const Anchor& anchor) { return anchor.until <= state.time; };
  if (std::any_of(model.anchors.begin(), model.anchors.end(), lets_go))
    return supports_of(System(system.scene(), state.time), state);
  const System::WorkspacePtr work = system.make_workspace();
  Eigen::VectorXd rate;
  if (!system.derivative(state, state.time, state.y, rate, *work).ok()) return {};
  std::vector<Support> out;
  for (const Anchor& anchor : model.scene.anchors) {
    Support& support = out.emplace_back();
    if (anchor.until <= model.from) continue;
    const std::size_t i = model.rods[anchor.rod].first + anchor.node;
    if (anchor.holds_position) support.force = force_on(model, anchor, i, state.time, work->pull);
    if (const Model::Slider* slider = model.slider_of(i)) support.force -= slider->free * support.force;
    if (anchor.holds_frame) support.torque = torque_on(model, anchor, i, state.time, *work);
    if (const Model::Swivel* swivel = model.swivel_of(i))
      support.torque =
          torque_on_swivel(model, static_cast<std::size_t>(swivel - model.swivels.data()), *work);
  }
  return out;
}

}  // namespace tendril
