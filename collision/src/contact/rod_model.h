#pragma once

#include <tendril/contact/rod_contact.h>

#include <cstdint>
#include <optional>

namespace tendril::contact {

/// A place on a rod that is followed as a point of its line.
struct LinePoint {
  std::uint32_t edge;  ///< of those of the model
  double fraction;     ///< along it
  double weight;       ///< its share of the rest length
};

/// An edge of a rod in contact, and its points [first, end).
struct LineEdge {
  std::uint32_t rod;     ///< of those in contact
  std::uint32_t node;    ///< its first, of the rod's
  std::uint32_t global;  ///< that node among the nodes of all rods in contact
  std::uint32_t first, end;
};

/// A point's contact with a solid at the last accepted state.
struct KeptTouch {
  std::uint64_t key;  ///< point times the number of colliders, plus the collider
  Vec3 stick_at;      ///< where it sticks, in the frame of the solid
  Vec3 x, friction;   ///< where it was in the world, and the friction on it
};

/// What is remembered besides what is told: where everything was at the last accepted state, and how far it
/// may move before a point comes into the range of a solid.
struct Ledger final : ContactMemory {
  std::vector<Vec3> p;             ///< of all nodes of rods in contact
  std::vector<Placement> placed;   ///< per collider
  std::vector<double> slack;       ///< per edge and collider: least gap less the range, or less
  std::vector<KeptTouch> touches;  ///< by ascending key, for find()

  /// Null where that point was not in the range of that solid.
  const KeptTouch* find(std::uint64_t key) const;
};

/// What a point of the line is to a solid.
struct Nearness {
  std::size_t point, collider;
  Vec3 x;                   ///< in the world
  Vec3 local;               ///< in the solid's frame
  double gap;               ///< less the margin between points
  const Placement* placed;  ///< of the solid
  double radius;            ///< of the rod
};

struct RodModel {
  RodModel(std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law);

  std::vector<ContactRod> rods;
  std::vector<Collider> colliders;
  Law law;
  double stick;                          ///< stiffness of what sticks
  bool driven = false;                   ///< some collider is
  std::vector<std::size_t> bodies = {};  ///< of the scene that are colliders, ascending
  std::vector<LineEdge> edges;
  std::vector<LinePoint> points;
  std::vector<double> margin;  ///< per edge and collider: by how much a gap is taken smaller
  std::size_t nodes = 0;       ///< of all rods in contact

  std::vector<Placement> place(const StateView& state) const;
  /// Flat index of an edge's first node in a state.
  std::size_t node_of(const StateView& state, const LineEdge& edge) const {
    return state.rods[rods[edge.rod].rod].first + edge.node;
  }
  /// The point of the line.
  static Vec3 between(const Vec3& a, const Vec3& b, double fraction) { return a + fraction * (b - a); }
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

 private:
  void lay_points(std::uint32_t rod, std::uint32_t global);
  std::size_t parts_of(double length, double radius) const;
  void lay_margins();
};

template <class Visit>
void RodModel::each_near(const StateView& state, const std::vector<Placement>& placed, const Ledger* kept,
                         Visit&& visit) const {
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t node = node_of(state, edges[e]);
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

/// [a] b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// What a solid does to a point of the line in its range.
struct Response {
  Vec3 normal;    ///< of the solid, in the world
  Vec3 force;     ///< on the point, friction included
  Vec3 friction;  ///< of it
  bool sticks;
  Vec3 stick_at;  ///< where it would stick from here on, in the frame of the solid
  Mat3 by_position = Mat3::Zero(), by_velocity = Mat3::Zero();  ///< of the force
};

/// Whether the straight way of a point whose gap is open, from `before` in the solid's frame, keeps the gap
/// open: spheres of free space along the way back [Hart 1996]. A step over less than 1e-4 of the range may
/// pass what is thinner than that of the widened solid, and so lies within the point's own radius.
/// \param radius  by which the solid is widened
bool clear_way(const Shape& shape, const Nearness& near, const Vec3& before, double radius, double range);

/// \param from      where the point stuck, in the frame of the solid; empty for nowhere yet
/// \param velocity  of the point
Response respond(const Shape& shape, const Law& law, double weight, double stick, const Nearness& near,
                 const std::optional<Vec3>& from, const Vec3& velocity);

}  // namespace tendril::contact
