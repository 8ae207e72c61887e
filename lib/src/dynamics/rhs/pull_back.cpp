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

TENDRIL_INLINE void add_across(std::size_t i, const V3& g, const Kinematics& kin, Columns3& to) {
  const V3 e = Reader(kin.e).at(i);
  Writer(to).add(i, kin.inverse_length[i] * (g - lanes::dot(e, g) * e));
}
/// What springs at held frames give the edges at their nodes.
TENDRIL_LANES void through_held_edges(const std::vector<std::size_t>& held, const Kinematics& kin,
                                      const Gradient& grad, Pull& pull) {
  for (const std::size_t node : held) {
    add_across(node - 1, Reader(grad.before).at(node), kin, pull.edge_force);
    add_across(node, Reader(grad.after).at(node), kin, pull.edge_force);
  }
}

TENDRIL_LANES void to_masses(std::size_t nodes, Pull& pull) {
  const Reader from(pull.edge_force);
  const Writer to(pull.force);
  TENDRIL_LOOP
  for (std::size_t i = 0; i < nodes; ++i) to.put(i, from.at(i) - from.at(i - 1));
}

TENDRIL_LANES void add_loads(std::size_t nodes, const double* __restrict load, Pull& pull) {
  const Reader from(pull.force);
  const Writer to(pull.force);
  TENDRIL_LOOP
  for (std::size_t i = 0; i < nodes; ++i)
    to.put(i, from.at(i) + V3{load[3 * i], load[3 * i + 1], load[3 * i + 2]});
}

/// What the root of a child rod feels goes to the node it is attached to: the force, and the torque T by
/// phi.T = g_t.(phi x t_0) + g_s phi.t_0 for the turn phi = t x dt + ds t of the parent's frame.
TENDRIL_INLINE void pass_on_torque(const Model::Attachment& attached, const Kinematics& kin, Gradient& grad,
                                   LoadColumns& loads) {
  if (!attached.reaction) return;
  const std::size_t i = attached.root, at = attached.parent;
  const V3 t0 = Reader(kin.frame.z).at(i), t = Reader(kin.frame.z).at(at);
  double along = grad.spin[i];
  if (!loads.torque.empty()) {
    const double* load = loads.torque[i].data();
    along -= lanes::dot(V3{load[0], load[1], load[2]}, t0);
    loads.torque[i].setZero();
  }
  const V3 torque = lanes::cross(t0, Reader(grad.tangent).at(i)) + along * t0;
  Writer(grad.tangent).add(at, lanes::cross(torque, t));
  Writer(grad.tangent).put(i, V3{});
  grad.spin[at] += lanes::dot(torque, t);
  grad.spin[i] = 0.0;
}
TENDRIL_LANES void pass_on_torques(const Model& model, const Kinematics& kin, Gradient& grad,
                                   LoadColumns& loads) {
  for (std::size_t k = model.attachments.size(); k-- > 0;)
    pass_on_torque(model.attachments[k], kin, grad, loads);
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
  pass_on_torques(model, kin, grad, loads);
  if (!model.swivels.empty()) turn_swivels(model, kin, grad, loads);
  for (const Segment& s : model.segments)
    (s.twist || model.acts_on_frames ? through_frames : through_hinges)(s.first, s.end, kin, grad, pull);
  through_held_edges(model.bending.held, kin, grad, pull);
  through_held_edges(model.bending.held_hinges, kin, grad, pull);
}

void pull_back(const Model& model, const Kinematics& kin, Gradient& grad, LoadColumns& loads, Pull& pull) {
  pull_on_edges(model, kin, grad, loads, pull);
  to_masses(model.nodes, pull);
  if (model.loaded && model.nodes > 0) add_loads(model.nodes, loads.load.front().data(), pull);
  for (auto attached = model.attachments.rbegin(); attached != model.attachments.rend(); ++attached)
    pass_on_force(*attached, pull);
}

}  // namespace tendril
