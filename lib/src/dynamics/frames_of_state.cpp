#include <cmath>

#include "elastic.h"

namespace tendril {
namespace {

using Workspace = System::Workspace;
using Model = System::Model;

/// Directors of a rod without twist state: one node's is carried in time (or held), the others' follow along
/// the rod at their rest twist.
void carry_along(const Model& model, const State& state, const NodeRange& rod, Workspace& work) {
  const std::size_t last = rod.first + rod.count - 1;
  std::size_t seed = rod.first;
  for (std::size_t i = rod.first; i <= last; ++i)
    if (model.holds_frame(i)) seed = i;
  const auto set = [&](std::size_t i, const Vec3& y) {
    const Vec3 t = work.frame.z[i];
    work.frame.y.set(i, (y - y.dot(t) * t).normalized());
  };
  if (!model.holds_frame(seed))
    set(seed, rotate_smallest(state.tangent[seed], work.frame.z[seed], state.director[seed]));
  const auto turned = [](const Vec3& axis, double angle, const Vec3& v) {
    return angle == 0.0 ? v : rotate_about(axis, angle, v);
  };
  for (std::size_t i = seed; i < last; ++i)
    set(i + 1, turned(work.frame.z[i + 1], model.rest_twist[i],
                      rotate_smallest(work.frame.z[i], work.frame.z[i + 1], work.frame.y[i])));
  for (std::size_t i = seed; i > rod.first; --i)
    set(i - 1, rotate_smallest(work.frame.z[i], work.frame.z[i - 1],
                               turned(work.frame.z[i], -model.rest_twist[i - 1], work.frame.y[i])));
}

Evaluation all_frames(const Model& model, const State& state, Workspace& work) {
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::places, work); !at.ok())
    return at;
  for (const NodeRange& rod : model.rods)
    if (!model.has_twist(rod.first)) carry_along(model, state, rod, work);
  return {};
}

}  // namespace

Evaluation System::rebase(State& state, Workspace& work) const {
  const Model& model = *model_;
  if (const Evaluation at = all_frames(model, state, work); !at.ok()) return at;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    state.y.segment<3>(at) = work.p[i];
    state.y.segment<3>(model.v_begin() + at) = work.v[i];
    // Rounding would let the director lean towards the tangent over many steps.
    const Frame frame = work.frame[i];
    state.tangent[i] = frame.z;
    state.director[i] = (frame.y - frame.y.dot(frame.z) * frame.z).normalized();
    if (!model.has_twist(i)) continue;
    state.y[model.theta_begin() + model.twist_index[i]] = 0.0;
    state.y[model.spin_begin() + model.twist_index[i]] = work.spin[i];
  }
  for (const NodeRange& rod : model.rods) {
    if (!model.has_twist(rod.first)) continue;  // keeps its rest twist
    for (std::size_t i = rod.first; i + 1 < rod.first + rod.count; ++i) {
      const double raw = twist_angle(work.frame[i], work.frame[i + 1]);
      state.twist[i] += std::remainder(raw - state.twist[i], 2 * M_PI);
    }
  }
  return {};
}

std::vector<Frame> System::frames(const State& state, Workspace& work) const {
  std::vector<Frame> frames;
  if (!all_frames(*model_, state, work).ok()) return frames;
  for (std::size_t i = 0; i < model_->nodes; ++i) frames.push_back(work.frame[i]);
  return frames;
}

std::vector<Vec3> System::orientation_masses(const State& state, Workspace& work) const {
  std::vector<Vec3> q;
  if (!all_frames(*model_, state, work).ok()) return q;
  for (std::size_t i = 0; i < model_->nodes; ++i) {
    const Vec3& offset = model_->offset[i];
    q.push_back(work.p[i] + offset.y() * work.frame.y[i] + offset.z() * work.frame.z[i]);
  }
  return q;
}

}  // namespace tendril
