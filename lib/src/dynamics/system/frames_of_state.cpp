#include <cmath>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/kinematics.h"

namespace tendril {
namespace {

/// Director of the node of a rod without twist state that the others follow: held, or carried in time.
Vec3 director_of_seed(const Model& model, const State& state, std::size_t seed, const Kinematics& kin) {
  if (model.holds_frame(seed)) return kin.frame.y[seed];
  const Vec3 t = kin.frame.z[seed];
  const Vec3 carried = rotate_smallest(state.tangent[seed], t, state.director[seed]);
  return (carried - carried.dot(t) * t).normalized();
}

/// Directors of a rod without twist state: one node's is carried in time (or held), the others' follow along
/// the rod at their rest twist.
void carry_along(const Model& model, const State& state, const NodeRange& rod, std::size_t seed,
                 Kinematics& kin) {
  const std::size_t last = rod.first + rod.count - 1;
  const auto set = [&](std::size_t i, const Vec3& y) {
    const Vec3 t = kin.frame.z[i];
    kin.frame.y.set(i, (y - y.dot(t) * t).normalized());
  };
  kin.frame.y.set(seed, director_of_seed(model, state, seed, kin));
  const auto turned = [](const Vec3& axis, double angle, const Vec3& v) {
    return angle == 0.0 ? v : rotate_about(axis, angle, v);
  };
  for (std::size_t i = seed; i < last; ++i)
    set(i + 1, turned(kin.frame.z[i + 1], model.rest_twist[i],
                      rotate_smallest(kin.frame.z[i], kin.frame.z[i + 1], kin.frame.y[i])));
  for (std::size_t i = seed; i > rod.first; --i)
    set(i - 1, rotate_smallest(kin.frame.z[i], kin.frame.z[i - 1],
                               turned(kin.frame.z[i], -model.rest_twist[i - 1], kin.frame.y[i])));
}

Evaluation all_frames(const Model& model, const State& state, Kinematics& kin) {
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  for (std::size_t r = 0; r < model.rods.size(); ++r)
    if (!model.has_twist(model.rods[r].first)) carry_along(model, state, model.rods[r], model.seed[r], kin);
  return {};
}

/// Makes the present frames of a rod with twist the reference, and follows its twists beyond half a turn.
void rebase_twisted(const Model& model, const NodeRange& rod, const Kinematics& kin, State& state) {
  for (std::size_t i = rod.first; i < rod.first + rod.count; ++i) {
    const Frame frame = kin.frame[i];
    state.tangent[i] = frame.z;
    // Rounding would let the director lean towards the tangent over many steps.
    state.director[i] = (frame.y - frame.y.dot(frame.z) * frame.z).normalized();
    state.y[model.theta_begin() + model.twist_index[i]] = 0.0;
    state.y[model.spin_begin() + model.twist_index[i]] = kin.spin[i];
    if (i + 1 == rod.first + rod.count) continue;
    const double raw = twist_angle(frame, kin.frame[i + 1]);
    state.twist[i] += std::remainder(raw - state.twist[i], 2 * M_PI);
  }
}

}  // namespace

Evaluation System::rebase(State& state, Workspace& work) const {
  const Model& model = *model_;
  Kinematics& kin = work.kinematics;
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  for (std::size_t i = 0; i < model.nodes; ++i) {
    if (!model.holds_position(i)) continue;
    const auto at = 3 * static_cast<Eigen::Index>(i);
    state.y.segment<3>(at) = kin.p[i];
    state.y.segment<3>(model.v_begin() + at) = kin.v[i];
  }
  for (std::size_t r = 0; r < model.rods.size(); ++r) {
    const NodeRange& rod = model.rods[r];
    if (model.has_twist(rod.first)) {
      rebase_twisted(model, rod, kin, state);
      continue;
    }
    const std::size_t seed = model.seed[r];
    state.director[seed] = director_of_seed(model, state, seed, kin);
    state.tangent[seed] = kin.frame.z[seed];
  }
  rebase_bodies(model, kin.bodies, state);
  return {};
}

std::vector<Frame> System::frames(const State& state, Workspace& work) const {
  std::vector<Frame> frames;
  Kinematics& kin = work.kinematics;
  if (!all_frames(*model_, state, kin).ok()) return frames;
  for (std::size_t i = 0; i < model_->nodes; ++i) frames.push_back(kin.frame[i]);
  return frames;
}

std::vector<Vec3> System::orientation_masses(const State& state, Workspace& work) const {
  std::vector<Vec3> q;
  Kinematics& kin = work.kinematics;
  if (!all_frames(*model_, state, kin).ok()) return q;
  for (std::size_t i = 0; i < model_->nodes; ++i) {
    const Vec3& offset = model_->offset[i];
    q.push_back(kin.p[i] + offset.y() * kin.frame.y[i] + offset.z() * kin.frame.z[i]);
  }
  return q;
}

}  // namespace tendril
