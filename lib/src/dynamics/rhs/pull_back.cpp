#include "pull_back.h"

#include "dynamics/vector/column_access.h"

namespace tendril {
namespace {

using Workspace = System::Workspace;
using Segment = Model::Segment;
using lanes::Reader;
using lanes::V3;
using lanes::Writer;

/// Forces along edges [first, end), whose gradients come from the bending at their two nodes and, with
/// Tangents, through the tangents there: by each edge of a node b (g - (g.t) t), b = 1 / |e_a + e_b|, where g
/// is across t already.
template <bool Tangents>
TENDRIL_INLINE void through_edges(std::size_t first, std::size_t end, Workspace& work) {
  const Reader e(work.e), bend(work.g_bend), tangent(work.g_tangent);
  const Writer to(work.edge_force);
  const double *__restrict g_length = work.g_length.data(), *__restrict inverse = work.inverse_length.data(),
               *__restrict b = work.inverse_bisector.data();
  TENDRIL_LOOP
  for (std::size_t i = first; i < end; ++i) {
    V3 g = bend.at(i) - bend.at(i + 1);
    if constexpr (Tangents) g = g + b[i] * tangent.at(i) + b[i + 1] * tangent.at(i + 1);
    const V3 ei = e.at(i);
    const double along = g_length[i] - inverse[i] * lanes::dot(ei, g);
    to.put(i, inverse[i] * g + along * ei);
  }
}
TENDRIL_LANES void through_hinges(std::size_t first, std::size_t end, Workspace& work) {
  through_edges<false>(first, end, work);
}
TENDRIL_LANES void through_frames(std::size_t first, std::size_t end, Workspace& work) {
  through_edges<true>(first, end, work);
}

/// What springs at a held frame give the edges at its node.
void through_held_edges(std::size_t node, Workspace& work) {
  const auto add = [&](std::size_t i, const Vec3& g) {
    const Vec3 e = work.e[i];
    work.edge_force.add(i, work.inverse_length[i] * (g - e.dot(g) * e));
  };
  add(node - 1, work.g_before[node]);
  add(node, work.g_after[node]);
}

TENDRIL_LANES void to_masses(std::size_t nodes, Workspace& work) {
  const Reader from(work.edge_force);
  const Writer to(work.force);
  TENDRIL_LOOP
  for (std::size_t i = 0; i < nodes; ++i) to.put(i, from.at(i) - from.at(i - 1));
}

/// What the root of a child rod feels goes to the node it rides on: the force, and the torque T by
/// phi.T = g_t.(phi x t_0) + g_s phi.t_0 for the turn phi = t x dt + ds t of the parent's frame.
void pass_on_torque(const Model::Ride& ride, Workspace& work) {
  if (!ride.reaction) return;
  const std::size_t i = ride.root;
  const Vec3 t0 = work.frame.z[i];
  const Vec3 t = work.frame.z[ride.parent];
  double along = work.g_spin[i];
  if (!work.torque.empty()) along -= work.torque[i].dot(t0);
  const Vec3 torque = t0.cross(work.g_tangent[i]) + along * t0;
  work.g_tangent.add(ride.parent, torque.cross(t));
  work.g_spin[ride.parent] += torque.dot(t);
  work.g_tangent.set(i, Vec3::Zero());
  work.g_spin[i] = 0.0;
  if (!work.torque.empty()) work.torque[i].setZero();
}

void pass_on_force(const Model::Ride& ride, Workspace& work) {
  if (!ride.reaction) return;
  work.force.add(ride.parent, work.force[ride.root]);
  work.force.set(ride.root, Vec3::Zero());
}

}  // namespace

void pull_on_edges(const Model& model, Workspace& work) {
  for (auto ride = model.rides.rbegin(); ride != model.rides.rend(); ++ride) pass_on_torque(*ride, work);
  for (const Segment& s : model.segments)
    (s.twist || model.loaded ? through_frames : through_hinges)(s.first, s.end, work);
  for (const auto* held : {&model.bending.held, &model.bending.held_hinges})
    for (const std::size_t node : *held) through_held_edges(node, work);
}

void pull_back(const Model& model, Workspace& work) {
  pull_on_edges(model, work);
  to_masses(model.nodes, work);
  if (model.loaded)
    for (std::size_t i = 0; i < model.nodes; ++i) work.force.add(i, work.load[i]);
  for (auto ride = model.rides.rbegin(); ride != model.rides.rend(); ++ride) pass_on_force(*ride, work);
}

}  // namespace tendril
