#include "pull_back.h"

#include "dynamics/vector/column_access.h"

namespace tendril {
namespace {

using Segment = Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// Forces along edges [first, end), whose gradients come from the bending at their two nodes and, with
/// Tangents, through the tangents there: by each edge of a node b (g - (g.t) t), b = 1 / |e_a + e_b|, where g
/// is across t already.
template <bool Tangents>
TENDRIL_INLINE void through_edges(std::size_t first, std::size_t end, const Kinematics& kin,
                                  const Gradient& grad, Pull& pull) {
  const Reader e(kin.e), bend(grad.bend), tangent(grad.tangent);
  const Writer to(pull.edge_force);
  const double *__restrict g_length = grad.length.data(), *__restrict inverse = kin.inverse_length.data(),
               *__restrict b = kin.inverse_bisector.data();
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    V3 g = bend.at(i) - bend.at(i + 1);
    if constexpr (Tangents) g = g + b[i] * tangent.at(i) + b[i + 1] * tangent.at(i + 1);
    const V3 ei = e.at(i);
    const double along = g_length[i] - inverse[i] * lanes::dot(ei, g);
    to.put(i, inverse[i] * g + along * ei);
  }
}
TENDRIL_LANES void through_hinges(std::size_t first, std::size_t end, const Kinematics& kin,
                                  const Gradient& grad, Pull& pull) {
  through_edges<false>(first, end, kin, grad, pull);
}
TENDRIL_LANES void through_frames(std::size_t first, std::size_t end, const Kinematics& kin,
                                  const Gradient& grad, Pull& pull) {
  through_edges<true>(first, end, kin, grad, pull);
}

/// What springs at a held frame give the edges at its node.
void through_held_edges(std::size_t node, const Kinematics& kin, const Gradient& grad, Pull& pull) {
  const auto add = [&](std::size_t i, const Vec3& g) {
    const Vec3 e = kin.e[i];
    pull.edge_force.add(i, kin.inverse_length[i] * (g - e.dot(g) * e));
  };
  add(node - 1, grad.before[node]);
  add(node, grad.after[node]);
}

TENDRIL_LANES void to_masses(std::size_t nodes, Pull& pull) {
  const Reader from(pull.edge_force);
  const Writer to(pull.force);
  TENDRIL_LOOP
  for (std::size_t i = 0; i < nodes; ++i) to.put(i, from.at(i) - from.at(i - 1));
}

/// What the root of a child rod feels goes to the node it is attached to: the force, and the torque T by
/// phi.T = g_t.(phi x t_0) + g_s phi.t_0 for the turn phi = t x dt + ds t of the parent's frame.
void pass_on_torque(const Model::Attachment& attached, const Kinematics& kin, Gradient& grad,
                    LoadColumns& loads) {
  if (!attached.reaction) return;
  const std::size_t i = attached.root;
  const Vec3 t0 = kin.frame.z[i];
  const Vec3 t = kin.frame.z[attached.parent];
  double along = grad.spin[i];
  if (!loads.torque.empty()) along -= loads.torque[i].dot(t0);
  const Vec3 torque = t0.cross(grad.tangent[i]) + along * t0;
  grad.tangent.add(attached.parent, torque.cross(t));
  grad.spin[attached.parent] += torque.dot(t);
  grad.tangent.set(i, Vec3::Zero());
  grad.spin[i] = 0.0;
  if (!loads.torque.empty()) loads.torque[i].setZero();
}

/// What turns a swivel about its axis stands for the gradient by its spin, from which the torque of loads is
/// taken yet.
void turn_swivels(const Model& model, const Kinematics& kin, Gradient& grad, const LoadColumns& loads) {
  for (std::size_t k = 0; k < model.swivels.size(); ++k) {
    const std::size_t i = model.swivels[k].node;
    const Frame frame = kin.frame[i];
    const double loaded = loads.torque.empty() ? 0.0 : loads.torque[i].dot(frame.z);
    grad.swivel[k] = frame.z.cross(Vec3(grad.tangent[i])) + (grad.spin[i] - loaded) * frame.z;
    grad.spin[i] = grad.swivel[k].dot(model.swivels[k].of(frame)) + loaded;
  }
}

void pass_on_force(const Model::Attachment& attached, Pull& pull) {
  if (!attached.reaction) return;
  pull.force.add(attached.parent, pull.force[attached.root]);
  pull.force.set(attached.root, Vec3::Zero());
}

}  // namespace

void pull_on_edges(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads,
                   Pull& pull) {
  assert(grad.made.fits(kin) && (!model.loaded || loads.made.fits(kin)));
  for (auto attached = model.attachments.rbegin(); attached != model.attachments.rend(); ++attached)
    pass_on_torque(*attached, kin, grad, loads);
  if (!model.swivels.empty()) turn_swivels(model, kin, grad, loads);
  for (const Segment& s : model.segments)
    (s.twist || model.turned ? through_frames : through_hinges)(s.first, s.end, kin, grad, pull);
  for (const auto* held : {&model.bending.held, &model.bending.held_hinges})
    for (const std::size_t node : *held) through_held_edges(node, kin, grad, pull);
}

void pull_back(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads, Pull& pull) {
  pull_on_edges(model, kin, grad, loads, pull);
  to_masses(model.nodes, pull);
  if (model.loaded)
    for (std::size_t i = 0; i < model.nodes; ++i) pull.force.add(i, loads.load[i]);
  for (auto attached = model.attachments.rbegin(); attached != model.attachments.rend(); ++attached)
    pass_on_force(*attached, pull);
}

}  // namespace tendril
