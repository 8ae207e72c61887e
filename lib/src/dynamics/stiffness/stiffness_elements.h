#pragma once

#include <algorithm>
#include <vector>

#include "edge_pack.h"
#include "edge_stiffness.h"
#include "hinge_band.h"

namespace tendril {

/// Hands the blocks of an edge's matrix to a sink: block(row node, column node, 3x3), column(row node, angle
/// node, 3), row(angle node, column node, 3), angles(angle node, angle node, number), each times `scale`.
template <class Sink>
void visit(const EdgeStiffness& e, double scale, Sink& sink) {
  for (std::size_t a = 0; a < 5; ++a) {
    if (e.node[a] == EdgeStiffness::kNone) continue;
    for (std::size_t b = a; b < 5; ++b) {
      if (e.node[b] == EdgeStiffness::kNone) continue;
      const Mat3 k = scale * e.k[a][b];
      if (e.node_feels[a]) sink.block(e.node[a], e.node[b], k);
      if (a < b && e.node_feels[b]) sink.block(e.node[b], e.node[a], Mat3(k.transpose()));
    }
    for (std::size_t b = 0; b < 2; ++b) {
      const Vec3 k = scale * e.by_angle[a][b];
      if (e.node_feels[a]) sink.column(e.node[a], e.angle[b], k);
      if (e.angle_feels[b]) sink.row(e.angle[b], e.node[a], k);
    }
  }
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      if (e.angle_feels[a]) sink.angles(e.angle[a], e.angle[b], scale * e.angles[a][b]);
}

/// The same of a matrix that is not symmetric.
template <class Sink>
void visit(const TurnedResistance& e, double scale, Sink& sink) {
  const EdgeStiffness& at = e.place;
  for (std::size_t a = 0; a < 5; ++a) {
    if (at.node[a] == EdgeStiffness::kNone) continue;
    for (std::size_t b = 0; b < 5; ++b)
      if (at.node[b] != EdgeStiffness::kNone && at.node_feels[a])
        sink.block(at.node[a], at.node[b], Mat3(scale * e.k[a][b]));
    for (std::size_t b = 0; b < 2; ++b) {
      if (at.node_feels[a]) sink.column(at.node[a], at.angle[b], Vec3(scale * e.by_angle[a][b]));
      if (at.angle_feels[b]) sink.row(at.angle[b], at.node[a], Vec3(scale * e.of_angle[b][a]));
    }
  }
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b)
      if (at.angle_feels[a]) sink.angles(at.angle[a], at.angle[b], scale * e.angles[a][b]);
}

/// Second derivatives by the vector from node i to the next.
template <class Sink>
void visit_edge(std::size_t i, const Mat3& k, double scale, Sink& sink) {
  sink.block(i, i, Mat3(scale * k));
  sink.block(i + 1, i + 1, Mat3(scale * k));
  sink.block(i, i + 1, Mat3(-scale * k));
  sink.block(i + 1, i, Mat3(-scale * k));
}

/// What the turn of a hub takes off the stiffness, by the rows of one of its children and the columns of
/// another: -dT^T give dT.
template <class Sink>
void visit_hub(const Eigen::Matrix2d& give, const HubSlopes& rows, const HubSlopes& columns, double scale,
               Sink& sink) {
  const EdgeStiffness &to = rows.place, &from = columns.place;
  const double g[2][2] = {{-scale * give(0, 0), -scale * give(0, 1)},
                          {-scale * give(1, 0), -scale * give(1, 1)}};
  for (std::size_t b = 0; b < 5; ++b) {
    if (from.node[b] == EdgeStiffness::kNone) continue;
    const Vec3 x = g[0][0] * columns.node[0][b] + g[0][1] * columns.node[1][b];
    const Vec3 y = g[1][0] * columns.node[0][b] + g[1][1] * columns.node[1][b];
    for (std::size_t a = 0; a < 5; ++a)
      if (to.node[a] != EdgeStiffness::kNone && to.node_feels[a])
        sink.block(to.node[a], from.node[b],
                   Mat3(rows.node[0][a] * x.transpose() + rows.node[1][a] * y.transpose()));
    for (std::size_t a = 0; a < 2; ++a)
      if (to.angle_feels[a])
        sink.row(to.angle[a], from.node[b], Vec3(rows.angle[0][a] * x + rows.angle[1][a] * y));
  }
  for (std::size_t b = 0; b < 2; ++b) {
    const double x = g[0][0] * columns.angle[0][b] + g[0][1] * columns.angle[1][b];
    const double y = g[1][0] * columns.angle[0][b] + g[1][1] * columns.angle[1][b];
    for (std::size_t a = 0; a < 5; ++a)
      if (to.node[a] != EdgeStiffness::kNone && to.node_feels[a])
        sink.column(to.node[a], from.angle[b], Vec3(x * rows.node[0][a] + y * rows.node[1][a]));
    for (std::size_t a = 0; a < 2; ++a)
      if (to.angle_feels[a])
        sink.angles(to.angle[a], from.angle[b], rows.angle[0][a] * x + rows.angle[1][a] * y);
  }
}

template <class Sink>
void visit_hubs(const Model& model, const State& reference, const Kinematics& kin, double scale, Sink& sink) {
  std::vector<HubSlopes> slopes;
  for (const Model::Hub& hub : model.hubs) {
    slopes.resize(hub.children.size());
    for (std::size_t c = 0; c < slopes.size(); ++c)
      hub_slopes(model, hub.children[c], reference, kin, slopes[c]);
    for (const HubSlopes& rows : slopes)
      for (const HubSlopes& columns : slopes) visit_hub(hub.give, rows, columns, scale, sink);
  }
}

/// Goes over the edges of a rod with twist: calls one(i) for one that begins a child rod, and for those of a
/// rod that has less than a pack or a swivel; pack(i, k) for the pack that begins with i, of which the first
/// k have been.
template <class One, class InPack>
void for_packs(const Model& model, const NodeRange& rod, const One& one, const InPack& pack) {
  std::size_t i = rod.first;
  const std::size_t end = rod.first + rod.count - 1;
  if (i < end && model.carrier[i] != i) one(i++);
  if (end < i + EdgePack::kEdges || model.swivels_in(rod))
    for (; i < end; ++i) one(i);
  for (; i < end; i += EdgePack::kEdges) {
    const std::size_t first = std::min(i, end - EdgePack::kEdges);
    pack(first, i - first);
  }
}

/// Hands a pack but for its first `skip` edges to a sink.
template <class Sink>
void visit(const Model& model, const EdgePack& pack, std::size_t i, std::size_t skip, Sink& sink) {
  constexpr std::size_t kBlocks = EdgePack::kBlocks;
  sink.blocks(kBlocks * (EdgePack::kEdges - skip), &pack.block[kBlocks * skip],
              [&](std::size_t k) { return place_in_pack(model, i + skip + k / kBlocks, k % kBlocks); });
}

/// Hands the exact stiffness of the whole scene, times `scale`, to a sink.
template <class Sink>
void visit_stiffness(const Model& model, const State& reference, const Kinematics& kin, const Gradient& grad,
                     bool viscous, double scale, Sink& sink) {
  assert(kin.has_frames() && grad.made.fits(kin));
  EdgeStiffness edge;
  EdgePack pack;
  for (const NodeRange& rod : model.rods) {
    if (model.has_twist(rod.first)) {
      const auto one = [&](std::size_t i) {
        edge_stiffness(model, rod, i, kin, grad, viscous, edge);
        visit(edge, scale, sink);
      };
      for_packs(model, rod, one, [&](std::size_t i, std::size_t skip) {
        edge_stiffness(model, i, kin, grad, viscous, scale, pack);
        visit(model, pack, i, skip, sink);
      });
      continue;
    }
    visit_hinges(model, rod, kin, scale, sink);
  }
  visit_hubs(model, reference, kin, scale, sink);
  for (const std::size_t node : model.bending.held_hinges) {
    if (model.has_before(node))
      visit_edge(node - 1, held_hinge_stiffness(model, node, node - 1, kin), scale, sink);
    if (model.has_after(node)) visit_edge(node, held_hinge_stiffness(model, node, node, kin), scale, sink);
  }
}

/// The same for the resistance, times minus the viscosity.
template <class Sink>
void visit_resistance(const Model& model, const Kinematics& kin, Sink& sink) {
  EdgeStiffness edge;
  EdgePack pack;
  for (const NodeRange& rod : model.rods) {
    const double scale = -model.viscosity[rod.first];
    if (scale == 0.0 || !model.has_twist(rod.first)) continue;
    const auto one = [&](std::size_t i) {
      edge_resistance(model, rod, i, kin, edge);
      visit(edge, scale, sink);
    };
    for_packs(model, rod, one, [&](std::size_t i, std::size_t skip) {
      edge_resistance(model, i, kin, scale, pack);
      visit(model, pack, i, skip, sink);
    });
  }
}

}  // namespace tendril
