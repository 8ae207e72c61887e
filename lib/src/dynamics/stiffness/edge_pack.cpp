#include "edge_pack.h"

#include "springs.h"

namespace tendril {
namespace {

using lanes::load;
using lanes::Matrix;
using lanes::Pack;
using lanes::Springs;
using lanes::Triple;
using V = Triple<Pack>;
using M = Matrix<Pack>;

/// Second derivatives by the edges before (0), at (1) and after (2) and the angles of the two nodes between;
/// blocks x <= y.
struct ByEdges {
  M k[3][3];
  V angle[3][2];
};

/// By the unit edges, from what the springs see: tangents are the normalised sums of their edges. As their
/// derivatives are across the tangents, t(e) turns by the inverse length of the sum alone.
TENDRIL_INLINE ByEdges by_unit_edges(const Springs<Pack>& s, const Pack& b0, const Pack& b1, const M& bent0,
                                     const M& bent1) {
  const M et0 = b0 * s.et[0];
  const M et1 = b1 * s.et[1];
  const M tt0 = (b0 * b0) * s.tt[0] + bent0;
  const M tt1 = (b1 * b1) * s.tt[1] + bent1;
  const M mixed = (b0 * b1) * s.t0_t1;
  ByEdges by;
  by.k[0][0] = tt0;
  by.k[0][1] = transposed(et0) + tt0 + mixed;
  by.k[0][2] = mixed;
  const M half = et0 + et1 + mixed;
  by.k[1][1] = s.ee + tt0 + tt1 + half + transposed(half);
  by.k[1][2] = et1 + tt1 + mixed;
  by.k[2][2] = tt1;
  for (std::size_t angle = 0; angle < 2; ++angle) {
    by.angle[0][angle] = b0 * s.t_theta[0][angle];
    by.angle[2][angle] = b1 * s.t_theta[1][angle];
    by.angle[1][angle] = s.e_theta[angle] + by.angle[0][angle] + by.angle[2][angle];
  }
  return by;
}

/// By the vectors d along the edges, e = d / |d|, times `scale`. What is not there has the inverse length 0.
TENDRIL_INLINE void to_vectors(const Kinematics& kin, std::size_t i, const Pack& scale, ByEdges& by) {
  const V e[3] = {load<Pack>(kin.e, i - 1), load<Pack>(kin.e, i), load<Pack>(kin.e, i + 1)};
  const double* inverse = kin.inverse_length.data() + i;
  const Pack s[3] = {load<Pack>(inverse - 1), load<Pack>(inverse), load<Pack>(inverse + 1)};
  const auto turn = [&](std::size_t x, std::size_t y) __attribute__((always_inline)) {
    by.k[x][y] = (scale * s[x] * s[y]) * project_right(project_left(e[x], by.k[x][y]), e[y]);
  };
  turn(0, 0);
  turn(0, 1);
  turn(0, 2);
  turn(1, 1);
  turn(1, 2);
  turn(2, 2);
  for (std::size_t x = 0; x < 3; ++x)
    for (auto& g : by.angle[x]) g = (scale * s[x]) * across(e[x], g);
}

/// Blocks (a, b) and (b, a) of k, the latter transposed, with the fourth row that belongs to each.
TENDRIL_INLINE void put(std::size_t a, std::size_t b, const M& k, const V& row_ab, const V& row_ba,
                        EdgePack& to) {
  constexpr std::size_t kStride = 16 * EdgePack::kBlocks;
  auto& ab = to.block[EdgePack::kSlots * a + b].column;
  put_columns(k.c[0], row_ab.x, ab[0].data(), kStride);
  put_columns(k.c[1], row_ab.y, ab[1].data(), kStride);
  put_columns(k.c[2], row_ab.z, ab[2].data(), kStride);
  if (a == b) return;
  const M transpose = transposed(k);
  auto& ba = to.block[EdgePack::kSlots * b + a].column;
  put_columns(transpose.c[0], row_ba.x, ba[0].data(), kStride);
  put_columns(transpose.c[1], row_ba.y, ba[1].data(), kStride);
  put_columns(transpose.c[2], row_ba.z, ba[2].data(), kStride);
}

TENDRIL_INLINE void put_angle(std::size_t a, std::size_t b, const V& k, const Pack& angles, EdgePack& to) {
  put_columns(k, angles, to.block[EdgePack::kSlots * a + b].column[3].data(), 16 * EdgePack::kBlocks);
}

/// From the vectors to the nodes that they join.
TENDRIL_INLINE void to_nodes(const ByEdges& by, const Pack& angle00, const Pack& angle01, const Pack& angle11,
                             EdgePack& to) {
  const V none{};
  const V g[4][2] = {{none - by.angle[0][0], none - by.angle[0][1]},
                     {by.angle[0][0] - by.angle[1][0], by.angle[0][1] - by.angle[1][1]},
                     {by.angle[1][0] - by.angle[2][0], by.angle[1][1] - by.angle[2][1]},
                     {by.angle[2][0], by.angle[2][1]}};
  const auto& k = by.k;
  const M zero{};
  const M before = k[0][1] - k[0][0];
  const M after = k[1][2] - k[2][2];
  const M beside = k[0][2] - k[0][1];
  const M beyond = k[0][2] - k[1][2];
  put(0, 0, k[0][0], none, none, to);
  put(0, 1, before, none, g[0][0], to);
  put(0, 2, beside, none, g[0][1], to);
  put(0, 3, zero - k[0][2], none, none, to);
  put(1, 1, k[1][1] - before - transposed(k[0][1]), g[1][0], g[1][0], to);
  put(1, 2, k[1][2] - k[1][1] - beside, g[2][0], g[1][1], to);
  put(1, 3, beyond, g[3][0], none, to);
  put(2, 2, k[1][1] - after - transposed(k[1][2]), g[2][1], g[2][1], to);
  put(2, 3, after, g[3][1], none, to);
  put(3, 3, k[2][2], none, none, to);
  for (std::size_t a = 0; a < 4; ++a) {
    const Pack nothing{};
    put_angle(a, 1, g[a][0], a == 1 ? angle00 : a == 2 ? angle01 : nothing, to);
    put_angle(a, 2, g[a][1], a == 1 ? angle01 : a == 2 ? angle11 : nothing, to);
  }
}

/// Curvature of the tangent t(e) at node i + side: see add_tangent_curvature. Where the frame is held, b = 0.
TENDRIL_INLINE M bent_tangent(const Model& model, std::size_t i, std::size_t side, const Kinematics& kin,
                              const Gradient& grad, const Pack& b, const Springs<Pack>& s) {
  const V t = load<Pack>(kin.frame.z, i + side);
  V g = load<Pack>(grad.tangent, i + side);
  if (side == 1) {
    Pack last{};
    for (std::size_t k = 0; k < EdgePack::kEdges; ++k) last[k] = model.has_after(i + 1 + k) ? 0.0 : 1.0;
    g = last * g;
  }
  return curvature_of_unit(t, b, g + dot(s.g_t[side], t) * t);
}

/// Curvature of e(d) and stretch of the edge itself, by d.
TENDRIL_INLINE M own_stiffness(const Model& model, std::size_t i, const Kinematics& kin, const V& gradient) {
  const V e = load<Pack>(kin.e, i);
  const Pack inverse = load<Pack>(kin.inverse_length.data() + i);
  const Pack stretch = load<Pack>(&model.stretch[i]);
  const Pack slack = load<Pack>(&model.rest_length[i]) * inverse;
  return curvature_of_unit(e, inverse, gradient) + outer((stretch * slack) * e, e) +
         lanes::diagonal<Pack>(stretch - stretch * slack);
}

TENDRIL_LANES void stiffness_of_pack(const Model& model, std::size_t i, const Kinematics& kin,
                                     const Gradient& grad, bool viscous, double scale, EdgePack& to) {
  const Springs<Pack> s = lanes::springs_of<Pack>(model, i, viscous, kin, grad);
  const Pack b0 = load<Pack>(kin.inverse_bisector.data() + i);
  const Pack b1 = load<Pack>(kin.inverse_bisector.data() + i + 1);
  ByEdges by = by_unit_edges(s, b0, b1, bent_tangent(model, i, 0, kin, grad, b0, s),
                             bent_tangent(model, i, 1, kin, grad, b1, s));
  const Pack all = Pack{} + scale;
  to_vectors(kin, i, all, by);
  const V gradient = s.g_e + b0 * load<Pack>(grad.tangent, i) + b1 * load<Pack>(grad.tangent, i + 1);
  by.k[1][1] = by.k[1][1] + all * own_stiffness(model, i, kin, gradient);
  to_nodes(by, all * s.theta[0], all * s.theta0_theta1, all * s.theta[1], to);
}

TENDRIL_LANES void resistance_of_pack(const Model& model, std::size_t i, const Kinematics& kin, double scale,
                                      EdgePack& to) {
  const Springs<Pack> s = lanes::resistance_of<Pack>(model, i, kin);
  const M straight{};
  ByEdges by = by_unit_edges(s, load<Pack>(kin.inverse_bisector.data() + i),
                             load<Pack>(kin.inverse_bisector.data() + i + 1), straight, straight);
  const Pack all = Pack{} + scale;
  to_vectors(kin, i, all, by);
  const V e = load<Pack>(kin.e, i);
  by.k[1][1] = by.k[1][1] + outer((all * load<Pack>(&model.stretch[i])) * e, e);
  to_nodes(by, all * s.theta[0], all * s.theta0_theta1, all * s.theta[1], to);
}

}  // namespace

void edge_stiffness(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                    bool viscous, double scale, EdgePack& to) {
  stiffness_of_pack(model, i, kin, grad, viscous, scale, to);
}

void edge_resistance(const Model& model, std::size_t i, const Kinematics& kin, double scale, EdgePack& to) {
  resistance_of_pack(model, i, kin, scale, to);
}

BlockPlace place_in_pack(const Model& model, std::size_t i, std::size_t k) {
  const auto there = [&](std::size_t slot) {
    return slot == 0 ? model.has_before(i) : slot < 3 || model.has_after(i + 1);
  };
  const std::size_t a = k / EdgePack::kSlots;
  const std::size_t b = k % EdgePack::kSlots;
  if (!there(a) || !there(b)) return {0, 0, false, false, false};
  const auto has_angle = [](std::size_t slot) { return slot == 1 || slot == 2; };
  return {model.carrier[i + a - 1], model.carrier[i + b - 1], model.feels[i + a - 1] != 0, has_angle(a),
          has_angle(b)};
}

}  // namespace tendril
