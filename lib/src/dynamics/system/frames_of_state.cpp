#include <cmath>

#include "dynamics/body/bodies.h"
#include "dynamics/rhs/kinematics.h"
#include "dynamics/vector/column_access.h"

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

/// Where the reference of a segment's nodes stands, three numbers a node or one.
struct ToReference {
  double* __restrict tangent;
  double* __restrict director;
  double* __restrict twist;
};

/// Makes the present frames of nodes [first, end) the reference, and follows the twists of the edges that
/// begin there beyond half a turn: by the angle of m_b about t_b from m_a, carried by the smallest rotation.
TENDRIL_LANES void take_reference(std::size_t first, std::size_t end, const Kinematics& kin,
                                  const ToReference& to) {
  const lanes::Reader m(kin.frame.y), t(kin.frame.z);
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    const lanes::V3 ta = t.at(i), tb = t.at(i + 1), ma = m.at(i), mb = m.at(i + 1);
    // Rounding would let the director lean towards the tangent over many steps.
    const lanes::V3 across = ma - lanes::dot(ma, ta) * ta;
    const double length = lanes::norm(across);
    const lanes::V3 director{across.x / length, across.y / length, across.z / length};
    const lanes::V3 carried = ma - (lanes::dot(tb, ma) / (1.0 + lanes::dot(ta, tb))) * (ta + tb);
    const double raw = lanes::angle(lanes::dot(lanes::cross(carried, mb), tb), lanes::dot(carried, mb));
    to.tangent[3 * i] = ta.x;
    to.tangent[3 * i + 1] = ta.y;
    to.tangent[3 * i + 2] = ta.z;
    to.director[3 * i] = director.x;
    to.director[3 * i + 1] = director.y;
    to.director[3 * i + 2] = director.z;
    to.twist[i] += lanes::less_turns(raw - to.twist[i]);
  }
}

void rebase_twisted(const Model& model, const Model::Segment& segment, const Kinematics& kin, State& state) {
  take_reference(segment.first, segment.end, kin,
                 {state.tangent.front().data(), state.director.front().data(), state.twist.data()});
  const Eigen::Index k = model.twist_index[segment.first];
  const auto count = static_cast<Eigen::Index>(segment.end - segment.first);
  state.y.segment(model.theta_begin() + k, count).setZero();
  std::copy_n(kin.spin.data() + segment.first, count, state.y.data() + model.spin_begin() + k);
}

}  // namespace

Evaluation System::rebase(State& state, Workspace& work) const {
  const Model& model = *model_;
  Kinematics& kin = work.kinematics;
  if (const Evaluation at = kinematics(model, state, state.time, state.y, Motion::positions, kin); !at.ok())
    return at;
  const auto put = [&](std::size_t i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    state.y.segment<3>(at) = kin.p[i];
    state.y.segment<3>(model.v_begin() + at) = kin.v[i];
  };
  for (std::size_t i = 0; i < model.nodes; ++i)
    if (model.holds_position(i)) put(i);
  for (const Model::Slider& slider : model.sliders) put(slider.node);
  for (const Model::Segment& segment : model.segments)
    if (segment.twist) rebase_twisted(model, segment, kin, state);
  for (std::size_t k = 0; k < model.swivels.size(); ++k)
    state.y[model.spin_begin() + model.twist_index[model.swivels[k].node]] = kin.swivel_spin[k];
  for (std::size_t r = 0; r < model.rods.size(); ++r) {
    const NodeRange& rod = model.rods[r];
    // No edge begins at a rod's last node.
    state.twist[rod.first + rod.count - 1] = 0.0;
    if (model.has_twist(rod.first)) continue;
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
