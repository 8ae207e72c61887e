#include "viscous_pack.h"

#include "springs.h"

namespace tendril {
namespace {

using lanes::load;
using lanes::Matrix;
using lanes::Pack;
using lanes::Triple;
using V = Triple<Pack>;
using M = Matrix<Pack>;

// What edge_stiffness.cpp says of one edge, without what only first edges of children and swivels have: those
// go there. Sums are taken by the vectors along three edges and turned to four nodes at the end: 25 products
// of vectors an edge, where by nodes there would be 52.

/// Where the vectors of a spring stand in a pack, and along which edge each is: 0 before, 1 at, 2 after.
struct Spring {
  std::size_t begin, edge, count;
};
constexpr Spring kSprings[] = {{0, 0, 2}, {2, 0, 2}, {4, 1, 2}, {6, 1, 2}, {8, 0, 3}};
constexpr std::size_t kTwist = 4;

TENDRIL_INLINE V load(const SlopePack& from, std::size_t k) {
  return {load<Pack>(from.along[k][0]), load<Pack>(from.along[k][1]), load<Pack>(from.along[k][2])};
}
TENDRIL_INLINE void store(const V& v, std::size_t k, SlopePack& to) {
  lanes::store(v.x, to.along[k][0]);
  lanes::store(v.y, to.along[k][1]);
  lanes::store(v.z, to.along[k][2]);
}

TENDRIL_INLINE V load(const std::vector<Vec3>& from, std::size_t i) {
  V v;
  for (std::size_t k = 0; k < EdgePack::kEdges; ++k)
    v.x[k] = from[i + k].x(), v.y[k] = from[i + k].y(), v.z[k] = from[i + k].z();
  return v;
}

/// The edges of the pack's neighbourhoods.
struct Edges {
  V e[3];
  Pack inverse[3];

  TENDRIL_INLINE Edges(std::size_t i, const Kinematics& kin) {
    for (std::size_t x = 0; x < 3; ++x) {
      e[x] = load<Pack>(kin.e, i + x - 1);
      inverse[x] = load<Pack>(kin.inverse_length.data() + (i + x - 1));  // 0 where there is none
    }
  }
  /// By the vector along an edge, from that by its direction.
  TENDRIL_INLINE V along(std::size_t x, const V& g) const { return inverse[x] * across(e[x], g); }
};

/// See carried_spin in edge_stiffness.cpp.
TENDRIL_INLINE V carried_spin(const V& from, const V& t) {
  return (2.0 / (1.0 + dot(from, t))) * cross(from, t);
}

/// Of both deviations at one end of the edges, as slopes_of has them: by the edge itself, and by the two
/// edges that the tangent halves, of which it is one. Where the frame is held the bisector's inverse is 0, so
/// that nothing turns with the edges.
TENDRIL_INLINE void slopes_at_end(std::size_t i, std::size_t side, const Edges& edges, const V& spin,
                                  const Kinematics& kin, SlopePack& to) {
  const lanes::Axes<Pack> f = lanes::axes_at<Pack>(kin, i + side);
  const V& e = edges.e[1];
  const lanes::Direction<Pack> d = lanes::direction<Pack>(e, f);
  const Pack b = load<Pack>(kin.inverse_bisector.data() + i + side);
  const Pack mixed = d.rise * d.x * d.y;
  const Pack by_x[2] = {d.ratio + d.rise * d.x * d.x, mixed};
  const Pack by_y[2] = {mixed, d.ratio + d.rise * d.y * d.y};
  const Pack by_z[2] = {-d.x, -d.y};
  for (std::size_t q = 0; q < 2; ++q) {
    const V beside = by_x[q] * f.l + by_y[q] * f.m;
    const Pack angle = by_x[q] * d.y - by_y[q] * d.x;
    const V by_tangent = by_z[q] * e - d.z * beside - angle * spin;
    const V share = b * across(f.t, by_tangent);
    const V own = edges.along(1, beside + by_z[q] * f.t + share);
    const V other = edges.along(2 * side, share);
    const std::size_t begin = kSprings[2 * side + q].begin;
    store(side == 0 ? other : own, begin, to);
    store(side == 0 ? own : other, begin + 1, to);
    lanes::store(angle, to.angle[2 * side + q]);
  }
}

TENDRIL_LANES void slopes_of_pack(std::size_t i, const State& reference, const Kinematics& kin,
                                  SlopePack& to) {
  const Edges edges(i, kin);
  const V ta = load<Pack>(kin.frame.z, i), tb = load<Pack>(kin.frame.z, i + 1);
  const V spin_a = carried_spin(load(reference.tangent, i), ta),
          spin_b = carried_spin(load(reference.tangent, i + 1), tb);
  slopes_at_end(i, 0, edges, spin_a, kin, to);
  slopes_at_end(i, 1, edges, spin_b, kin, to);
  // The twist goes with the difference of the angles, so that the carried spins enter with either sign.
  const V turn = (1.0 / (1.0 + dot(ta, tb))) * cross(ta, tb);
  const V share_a = load<Pack>(kin.inverse_bisector.data() + i) * across(ta, turn + spin_a);
  const V share_b = load<Pack>(kin.inverse_bisector.data() + i + 1) * across(tb, turn - spin_b);
  const std::size_t begin = kSprings[kTwist].begin;
  store(edges.along(0, share_a), begin, to);
  store(edges.along(1, share_a + share_b), begin + 1, to);
  store(edges.along(2, share_b), begin + 2, to);
}

/// By the vectors along the edges before, at and after, and by the angles of the two nodes between.
struct Turned {
  M k[3][3]{};
  V by_angle[3][2]{}, of_angle[2][3]{};
  Pack angles[2]{};  ///< each by itself
};

TENDRIL_INLINE void add_spring(std::size_t q, const Pack& stiffness, const SlopePack& at,
                               const SlopePack& before, const SlopePack& later, const Pack& per_time,
                               Turned& to) {
  const Spring& s = kSprings[q];
  V g[3], rate[3];
  for (std::size_t x = 0; x < s.count; ++x) {
    g[x] = stiffness * load(at, s.begin + x);
    rate[x] = per_time * (load(later, s.begin + x) - load(before, s.begin + x));
  }
  for (std::size_t x = 0; x < s.count; ++x)
    for (std::size_t y = 0; y < s.count; ++y) {
      M& k = to.k[s.edge + x][s.edge + y];
      k = k + outer(g[x], rate[y]);
    }
  // Its slopes by the angles are -1 and 1 at any state: they do not turn.
  if (q == kTwist) {
    for (std::size_t y = 0; y < 3; ++y) {
      to.of_angle[0][y] = to.of_angle[0][y] - stiffness * rate[y];
      to.of_angle[1][y] = to.of_angle[1][y] + stiffness * rate[y];
    }
    return;
  }
  const std::size_t side = q / 2;
  const Pack angle = stiffness * load<Pack>(at.angle[q]);
  const Pack turns = per_time * (load<Pack>(later.angle[q]) - load<Pack>(before.angle[q]));
  for (std::size_t x = 0; x < 2; ++x) {
    V& by = to.by_angle[s.edge + x][side];
    by = by + turns * g[x];
    V& of = to.of_angle[side][s.edge + x];
    of = of + angle * rate[x];
  }
  to.angles[side] = to.angles[side] + angle * turns;
}

/// See turned_pull.
TENDRIL_INLINE M pull_of(const Model& model, std::size_t i, const Kinematics& kin) {
  const V e = load<Pack>(kin.e, i), v = load<Pack>(kin.v, i + 1) - load<Pack>(kin.v, i);
  const Pack along = dot(e, v);
  const Pack k = load<Pack>(&model.viscosity[i]) * load<Pack>(&model.stretch[i]) *
                 load<Pack>(kin.inverse_length.data() + i);
  return outer(k * e, v - (along + along) * e) + lanes::diagonal<Pack>(k * along);
}

constexpr std::size_t kStride = 16 * EdgePack::kBlocks;

/// From the vectors to the nodes that they join: each goes to the one with a minus, to the next with a plus.
TENDRIL_INLINE void to_nodes(const Turned& from, EdgePack& to) {
  const M none{};
  const V zero{};
  const Pack nothing{};
  // By the vectors, with none beyond the first and the last.
  const auto k = [&](std::size_t x, std::size_t y) __attribute__((always_inline)) {
    return x - 1 < 3 && y - 1 < 3 ? from.k[x - 1][y - 1] : none;
  };
  const auto of = [&](std::size_t angle, std::size_t y) __attribute__((always_inline)) {
    return y - 1 < 3 ? from.of_angle[angle][y - 1] : zero;
  };
  const auto by = [&](std::size_t x, std::size_t angle) __attribute__((always_inline)) {
    return x - 1 < 3 ? from.by_angle[x - 1][angle] : zero;
  };
  for (std::size_t a = 0; a < EdgePack::kSlots; ++a)
    for (std::size_t b = 0; b < EdgePack::kSlots; ++b) {
      const M block = k(a + 1, b + 1) - k(a + 1, b) - k(a, b + 1) + k(a, b);
      const V row = a == 1 || a == 2 ? of(a - 1, b) - of(a - 1, b + 1) : zero;
      auto& column = to.block[EdgePack::kSlots * a + b].column;
      put_columns(block.c[0], row.x, column[0].data(), kStride);
      put_columns(block.c[1], row.y, column[1].data(), kStride);
      put_columns(block.c[2], row.z, column[2].data(), kStride);
      if (b == 1 || b == 2)
        put_columns(by(a, b - 1) - by(a + 1, b - 1), a == b ? from.angles[a - 1] : nothing, column[3].data(),
                    kStride);
    }
}

TENDRIL_LANES void resistance_of_pack(const Model& model, std::size_t i, const Kinematics& kin,
                                      const SlopePack& at, const SlopePack& before, const SlopePack& later,
                                      double apart, EdgePack& to) {
  const double* const stiffness[] = {&model.bend_l[i], &model.bend_m[i], &model.bend_l[i + 1],
                                     &model.bend_m[i + 1], &model.twist[i]};
  const Pack scale = -load<Pack>(&model.viscosity[i]);
  const Pack per_time = Pack{} + 1.0 / apart;
  Turned turned;
  for (std::size_t q = 0; q < 5; ++q)
    add_spring(q, scale * load<Pack>(stiffness[q]), at, before, later, per_time, turned);
  turned.k[1][1] = turned.k[1][1] - pull_of(model, i, kin);
  to_nodes(turned, to);
}

}  // namespace

void edge_slopes(std::size_t i, const State& reference, const Kinematics& kin, SlopePack& to) {
  slopes_of_pack(i, reference, kin, to);
}

void turned_resistance(const Model& model, std::size_t i, const Kinematics& kin, const SlopePack& at,
                       const SlopePack& before, const SlopePack& later, double apart, EdgePack& to) {
  resistance_of_pack(model, i, kin, at, before, later, apart, to);
}

}  // namespace tendril
