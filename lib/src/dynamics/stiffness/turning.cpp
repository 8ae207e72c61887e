#include "turning.h"

#include "dynamics/vector/pack.h"

namespace tendril {
namespace {

using lanes::load;
using lanes::Matrix;
using lanes::Pack;
using lanes::Triple;

/// By the vectors along the two edges.
template <class T>
struct TurningTerms {
  Matrix<T> by_x[2][2], by_v[2][2];  ///< force on d_k by d_j, d_j'
  Triple<T> by_spin[2];              ///< force on d_k by w
  Triple<T> connection[2];           ///< theta' by d_k
};

// With P = 1 - t t^T, s the inverse length of the tangent's bisector, U_k = (1 - e_k e_k^T) / |d_k|, the
// tangent turns by R_k = s P U_k. Since t' and g = t x t' are across t, P [t]x P = [t]x and P [t']x P = 0,
// and all that is left of the products of projectors are outer products:
//   R_k^T [t]x R_j = s^2 U_k [t]x U_j,
//   by positions   U_k (M U_j + s^2 I w [t]x V_j),
//   M = -s^2 ((g_s / 2 + I w t.b') [t]x + I w (2 g t^T + t g^T)),
// with b' = s (e_0' + e_1') and V_j = -(e_j.d_j' / |d_j| (1 - e e^T) + e' e^T + e e'^T) / |d_j| the
// derivative of e_j' by d_j.
template <class T>
TENDRIL_INLINE void terms_at(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                             TurningTerms<T>& to) {
  const Triple<T> t = load<T>(kin.frame.z, i);
  const Triple<T> g = load<T>(kin.rate.turning, i);
  const T s = load<T>(kin.inverse_bisector.data() + i);
  const T inertia = load<T>(&model.inertia[i]);
  const T momentum = inertia * load<T>(kin.spin.data() + i);
  const T half_spin = 0.5 * load<T>(grad.spin.data() + i);
  const T along = s * dot(t, load<T>(kin.rate.e_rate, i - 1) + load<T>(kin.rate.e_rate, i));
  const T square = s * s;
  const T weight = square * momentum;
  const Matrix<T> cross_t = cross_matrix(t);
  const Matrix<T> m =
      (-square * (half_spin + momentum * along)) * cross_t - weight * (outer(g + g, t) + outer(t, g));

  Triple<T> e[2];
  T inverse[2];
  for (std::size_t j = 0; j < 2; ++j) {
    e[j] = load<T>(kin.e, i + j - 1);
    inverse[j] = load<T>(kin.inverse_length.data() + (i + j - 1));  // 0 where there is no edge
  }
  for (std::size_t j = 0; j < 2; ++j) {
    const Triple<T> e_rate = load<T>(kin.rate.e_rate, i + j - 1);
    const T shortening = inverse[j] * load<T>(kin.rate.length_rate.data() + (i + j - 1));
    const T share = weight * inverse[j];
    const Matrix<T> turned = share * project_right(cross_t, e[j]);
    const Matrix<T> by_x = inverse[j] * project_right(m, e[j]) - shortening * turned -
                           outer(share * cross(t, e_rate), e[j]) - outer(share * cross(t, e[j]), e_rate);
    for (std::size_t k = 0; k < 2; ++k) {
      to.by_v[k][j] = inverse[k] * project_left(e[k], turned);
      to.by_x[k][j] = inverse[k] * project_left(e[k], by_x);
    }
    const Triple<T> turn = (s * inverse[j]) * across(e[j], g);
    to.by_x[j][j] = to.by_x[j][j] + momentum * curvature_of_unit<T>(e[j], inverse[j], s * g);
    to.by_spin[j] = inertia * turn;
    to.connection[j] = (-0.5 + T{}) * turn;
  }
}

constexpr std::size_t kStride = 16 * TurningPack::kBlocks;

template <class T>
TENDRIL_INLINE void put(const Matrix<T>& k, Block<4>& to) {
  const T none{};
  for (std::size_t c = 0; c < 3; ++c) put_columns(k.c[c], none, to.column[c].data(), kStride);
}

/// From the vectors to the nodes that they join.
template <class T>
TENDRIL_INLINE void to_nodes(const Matrix<T> (&k)[2][2], Block<4>* to) {
  const Matrix<T> none{};
  const Matrix<T> first = k[0][1] - k[0][0];
  const Matrix<T> last = k[1][0] - k[1][1];
  put(k[0][0], to[0]);
  put(first, to[1]);
  put(none - k[0][1], to[2]);
  put(k[1][0] - k[0][0], to[3]);
  put(none - first - last, to[4]);
  put(k[0][1] - k[1][1], to[5]);
  put(none - k[1][0], to[6]);
  put(last, to[7]);
  put(k[1][1], to[8]);
}

template <class T>
TENDRIL_INLINE void turn(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                         TurningPack& to) {
  TurningTerms<T> terms;
  terms_at<T>(model, i, kin, grad, terms);
  to_nodes<T>(terms.by_x, to.by_x.data());
  to_nodes<T>(terms.by_v, to.by_v.data());
  const T zero{};
  const Triple<T> none{};
  const auto put_differences = [&](const Triple<T>(&by)[2], double* at, std::size_t apart, std::size_t stride)
      __attribute__((always_inline)) {
    put_columns(none - by[0], zero, at, stride);
    put_columns(by[0] - by[1], zero, at + apart, stride);
    put_columns(by[1], zero, at + 2 * apart, stride);
  };
  put_differences(terms.by_spin, to.by_v[1].column[3].data(), 16 * TurningPack::kSlots, kStride);
  put_differences(terms.connection, to.connection[0][0], 4, 4 * TurningPack::kSlots);
}

TENDRIL_LANES void turn_pack(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                             TurningPack& to) {
  turn<Pack>(model, i, kin, grad, to);
}
TENDRIL_LANES void turn_one(const Model& model, std::size_t i, const Kinematics& kin, const Gradient& grad,
                            TurningPack& to) {
  turn<double>(model, i, kin, grad, to);
}

}  // namespace

void turning_terms(const Model& model, std::size_t i, std::size_t count, const Kinematics& kin,
                   const Gradient& grad, TurningPack& to) {
  assert(kin.has_rates() && grad.made.fits(kin));
  (count == 1 ? turn_one : turn_pack)(model, i, kin, grad, to);
}

BlockPlace place_of_turning(const Model& model, std::size_t i, std::size_t k) {
  const auto there = [&](std::size_t slot) {
    return slot == 0 ? model.has_before(i) : slot == 1 || model.has_after(i);
  };
  const std::size_t a = k / TurningPack::kSlots;
  const std::size_t b = k % TurningPack::kSlots;
  if (model.holds_frame(i) || !there(a) || !there(b)) return {0, 0, false, false, false};
  return {model.carrier[i + a - 1], model.carrier[i + b - 1], model.feels[i + a - 1] != 0, false, b == 1};
}

}  // namespace tendril
