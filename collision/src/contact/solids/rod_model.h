#pragma once

#include <tendril/contact/rod_contact.h>

#include <cstdint>

#include "contact/by_key.h"
#include "contact/kept_touch.h"
#include "contact/response.h"
#include "contact/rod_line.h"
#include "contact/solids.h"

namespace tendril::contact {

/// What is remembered besides what is told: where everything was at the last accepted state, and how far it
/// may move before a point comes into the range of a solid.
struct Ledger final : ContactMemory {
  std::vector<Vec3> p;             ///< of all nodes of rods in contact
  std::vector<Placement> placed;   ///< per collider
  std::vector<double> slack;       ///< per edge and collider: least gap less the range, or less
  std::vector<KeptTouch> touches;  ///< by ascending key
};

struct RodModel {
  RodModel(std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law);

  Law law;
  Solids colliders;
  RodLines lines;
  std::vector<double> margin;  ///< per edge and collider: by how much a gap is taken smaller

  bool barrier() const { return law.kind == Law::Kind::barrier; }

  /// How far the edge's ends moved in the solid's frame since the ledger was kept.
  double moved(const Ledger& kept, const LineEdge& edge, const Vec3& a, const Vec3& b, std::size_t collider,
               const Placement& placed) const;
  /// What a point is to a solid; only the gap is measured.
  Nearness nearness(const StateView& state, std::size_t point, std::size_t collider,
                    const Placement& placed) const;
  /// Where a point was when the ledger was kept, in the frame of a solid.
  Vec3 local_before(const Ledger& kept, const LinePoint& at, std::size_t collider) const;
  /// False where a point whose gap is open cannot have come straight from where it was without closing it.
  bool reachable(const Ledger& kept, const Nearness& near) const;

  /// Calls visit(Nearness) for all points of edges that may be in the range of a solid; it returns false to
  /// end.
  template <class Visit>
  void each_near(const StateView& state, const std::vector<Placement>& placed, const Ledger* kept,
                 Visit&& visit) const;
};

template <class Visit>
void RodModel::each_near(const StateView& state, const std::vector<Placement>& placed, const Ledger* kept,
                         Visit&& visit) const {
  const auto& edges = lines.edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t node = lines.node_of(state, edges[e]);
    const Vec3 &a = state.p[node], &b = state.p[node + 1];
    for (std::size_t c = 0; c < colliders.size(); ++c) {
      if (kept) {
        const double slack = kept->slack[e * colliders.size() + c];
        if (slack > 0.0 && moved(*kept, edges[e], a, b, c, placed[c]) < slack) continue;
      }
      for (std::size_t i = edges[e].first; i < edges[e].end; ++i)
        if (!visit(nearness(state, i, c, placed[c]))) return;
    }
  }
}

}  // namespace tendril::contact
