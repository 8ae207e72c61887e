#include <cmath>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/tiles/rebase.h"
#include "dynamics/vector/column_access.h"

namespace tendril {
namespace {

/// Directors of a rod without twist state: one node's is carried in time (or held), the others' follow along
/// the rod at their rest twist.
void carry_along(const Model& model, const State& state, const NodeRange& rod, std::size_t seed,
                 Kinematics& kin) {
  const std::size_t last = rod.first + rod.count - 1;
  const auto set = [&](std::size_t i, const Vec3& y) {
    const Vec3 t = kin.frame.z[i];
    kin.frame.y.set(i, (y - y.dot(t) * t).normalized());
  };
  kin.frame.y.set(seed, director_of_seed(model, state, seed, kin.frame[seed]));
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

}  // namespace

Evaluation System::rebase(State& state, Workspace& work) const {
  const Model& model = *model_;
  // Where a tile has no frames the whole says why.
  if (model.tiles && rebase_tiles(model, state, work)) return {};
  Kinematics& kin = work.kinematics;
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  std::size_t rod = 0;
  rebase_seen(model, {model, kin, 0, 0, model.nodes}, rod, state);
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
