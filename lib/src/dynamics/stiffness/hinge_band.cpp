#include "hinge_band.h"

#include "springs.h"

namespace tendril {
namespace {

using lanes::ByCosine;
using lanes::load;
using lanes::Matrix;
using lanes::Pack;
using lanes::store;
using lanes::Triple;

/// Of a stretch of nodes, the one before and the one after, numbers of matrices side by side: with the hinge
/// at node i between the edges i - 1 and i, what edge i gets from its stretch and that hinge (symmetric, six
/// numbers), what edge i - 1 gets from it (likewise), and that of edge i - 1 by edge i.
struct Terms {
  static constexpr std::size_t kSize = HingeBand::kNodes + 2;
  double after[6][kSize], before[6][kSize], mixed[9][kSize];
};

template <class T>
TENDRIL_INLINE void store(const Matrix<T>& m, std::size_t at, double (&to)[9][Terms::kSize]) {
  for (std::size_t c = 0; c < 3; ++c) {
    store(m.c[c].x, &to[3 * c][at]);
    store(m.c[c].y, &to[3 * c + 1][at]);
    store(m.c[c].z, &to[3 * c + 2][at]);
  }
}
template <class T>
TENDRIL_INLINE void store(const Matrix<T>& m, std::size_t at, double (&to)[6][Terms::kSize]) {
  store(m.c[0].x, &to[0][at]);
  store(m.c[0].y, &to[1][at]);
  store(m.c[0].z, &to[2][at]);
  store(m.c[1].y, &to[3][at]);
  store(m.c[1].z, &to[4][at]);
  store(m.c[2].z, &to[5][at]);
}
template <class T>
TENDRIL_INLINE Matrix<T> load_matrix(const double (&from)[9][Terms::kSize], std::size_t at) {
  Matrix<T> m;
  for (std::size_t c = 0; c < 3; ++c)
    m.c[c] = {load<T>(&from[3 * c][at]), load<T>(&from[3 * c + 1][at]), load<T>(&from[3 * c + 2][at])};
  return m;
}
template <class T>
TENDRIL_INLINE Matrix<T> load_matrix(const double (&from)[6][Terms::kSize], std::size_t at) {
  const T xy = load<T>(&from[1][at]);
  const T xz = load<T>(&from[2][at]);
  const T yz = load<T>(&from[4][at]);
  return {
      {{load<T>(&from[0][at]), xy, xz}, {xy, load<T>(&from[3][at]), yz}, {xz, yz, load<T>(&from[5][at])}}};
}

/// Slope and curvature of 1/2 K angle^2 by the cosine z of an angle, w the square of its sine.
template <class T>
struct ByCosines {
  T slope, curvature;
};

/// That of one node, however far it turns.
ByCosine any_angle(double stiffness, double w, double z) {
  const double sine = std::sqrt(w);
  const bool near = z > 0.0 && w <= lanes::kWideSquare;
  const double angle = near ? sine * lanes::wide_asin_ratio(w) : std::atan2(sine, z);
  return lanes::by_cosine(stiffness, angle, 0.0, sine, z);
}

/// Whether angles are small, or have no spring.
TENDRIL_INLINE bool near_angles(double stiffness, double w, double z) {
  return lanes::all_near(w, z) || stiffness == 0.0;
}
TENDRIL_INLINE bool near_angles(const Pack& stiffness, const Pack& w, const Pack& z) {
  bool near = true;
  for (std::size_t k = 0; k < lanes::kLanes<Pack>; ++k) near &= near_angles(stiffness[k], w[k], z[k]);
  return near;
}

/// With r the ratio of angle and sine, the slope is -K r, and the curvature K (1 - r z) / w = K z rise with
/// the arc's rise (1 / z - r) / w.
template <class T>
TENDRIL_INLINE ByCosines<T> by_cosines(const T& stiffness, const T& w, const T& z) {
  if (near_angles(stiffness, w, z)) {
    const lanes::ArcOf<T> arc = lanes::near_arc(w);
    return {-(stiffness * arc.ratio), stiffness * z * arc.rise};
  }
  ByCosines<T> by{};
  for (std::size_t k = 0; k < lanes::kLanes<T>; ++k) {
    const ByCosine one = any_angle(lanes::lane(stiffness, k), lanes::lane(w, k), lanes::lane(z, k));
    lanes::set_lane(by.slope, k, one.slope);
    lanes::set_lane(by.curvature, k, one.curvature);
  }
  return by;
}

/// Of e(d).t by d, for a spring on the cosine between them; u = (t - z e) / |d|.
template <class T>
TENDRIL_INLINE Matrix<T> by_edge(const ByCosines<T>& w, const Triple<T>& e, const Triple<T>& u, const T& z,
                                 const T& inverse) {
  const T bent = w.slope * inverse;
  const T along = bent * inverse * z;
  // -s z (1 - e e^T) / |d|^2 - s (e u^T + u e^T) / |d|
  return outer(w.curvature * u - bent * e, u) + outer(along * e - bent * u, e) - lanes::diagonal<T>(along);
}

template <class T>
TENDRIL_INLINE void terms_at(const Model& model, std::size_t i, const Kinematics& kin, double scale,
                             std::size_t at, Terms& to) {
  const Triple<T> a = load<T>(kin.e, i - 1);
  const Triple<T> b = load<T>(kin.e, i);
  const double* inverse = kin.inverse_length.data() + i;
  const T la = load<T>(inverse - 1);
  const T lb = load<T>(inverse);
  const T z = dot(a, b);
  const Triple<T> normal = cross(a, b);
  const ByCosines<T> w =
      by_cosines<T>((0.5 * scale) * load<T>(model.bending.hinge.data() + i), dot(normal, normal), z);
  const Triple<T> u = la * (b - z * a);
  const Triple<T> v = lb * (a - z * b);
  store(by_edge(w, a, u, z, la), at, to.before);
  // (1 - a a^T)(1 - b b^T) = 1 - a a^T - b b^T + z a b^T
  const T slope = w.slope * la * lb;
  store(outer(w.curvature * u, v) + lanes::diagonal<T>(slope) - outer(slope * a, a) +
            outer(slope * (z * a - b), b),
        at, to.mixed);
  const T stretch = scale * load<T>(&model.stretch[i]);
  const T slack = stretch * load<T>(&model.rest_length[i]) * lb;
  store(by_edge(w, b, v, z, lb) + outer(slack * b, b) + lanes::diagonal<T>(stretch - slack), at, to.after);
}

template <class T>
TENDRIL_INLINE void put(const Matrix<T>& k, Block<3>& to) {
  const T none{};
  for (std::size_t c = 0; c < 3; ++c) put_columns(k.c[c], none, to.column[c].data(), 12 * HingeBand::kBlocks);
}

/// With D_i of edge i by itself and M_i of the edges i - 1 and i, position j ends edge j - 1 and begins
/// edge j.
template <class T>
TENDRIL_INLINE void to_nodes(const Terms& from, std::size_t at, Block<3>* to) {
  const Matrix<T> mixed = load_matrix<T>(from.mixed, at);
  const Matrix<T> next = load_matrix<T>(from.mixed, at + 1);
  const Matrix<T> before = load_matrix<T>(from.after, at - 1) + load_matrix<T>(from.before, at);
  const Matrix<T> after = load_matrix<T>(from.after, at) + load_matrix<T>(from.before, at + 1);
  put(before + after - mixed - transposed(mixed), to[0]);
  const Matrix<T> upper = mixed - after + next;
  put(upper, to[1]);
  put(transposed(upper), to[2]);
  const Matrix<T> far = Matrix<T>{} - next;
  put(far, to[3]);
  put(transposed(far), to[4]);
}

/// Calls one(i) or, from each of these on, pack(i) for four in a row, until all of [first, end) have been.
template <class One, class InPack>
TENDRIL_INLINE void in_packs(std::size_t first, std::size_t end, const One& one, const InPack& pack) {
  constexpr std::size_t kPack = lanes::kLanes<Pack>;
  if (end < first + kPack)
    for (std::size_t i = first; i < end; ++i) one(i);
  else
    for (std::size_t i = first; i < end; i += kPack) pack(std::min(i, end - kPack));
}

TENDRIL_LANES void fill(const Model& model, std::size_t first, std::size_t end, std::size_t at,
                        const Kinematics& kin, double scale, Terms& to) {
  in_packs(
      first, end,
      [&](std::size_t i)
          __attribute__((always_inline)) { terms_at<double>(model, i, kin, scale, at + i - first, to); },
      [&](std::size_t i)
          __attribute__((always_inline)) { terms_at<Pack>(model, i, kin, scale, at + i - first, to); });
}

TENDRIL_LANES void gather(const Terms& from, std::size_t count, Block<3>* to) {
  in_packs(
      0, count,
      [&](std::size_t k)
          __attribute__((always_inline)) { to_nodes<double>(from, k + 1, to + HingeBand::kBlocks * k); },
      [&](std::size_t k)
          __attribute__((always_inline)) { to_nodes<Pack>(from, k + 1, to + HingeBand::kBlocks * k); });
}

}  // namespace

void hinge_stiffness(const Model& model, const NodeRange& rod, std::size_t first, std::size_t count,
                     const Kinematics& kin, double scale, HingeBand& to) {
  Terms terms;
  const auto clear = [&](std::size_t at) {
    for (auto* numbers : {terms.after, terms.before})
      for (std::size_t k = 0; k < 6; ++k) numbers[k][at] = 0.0;
    for (auto& numbers : terms.mixed) numbers[at] = 0.0;
  };
  const bool begins = first == rod.first;
  const bool ends = first + count == rod.first + rod.count;
  if (begins) clear(0);
  if (ends) clear(count + 1);
  fill(model, begins ? first : first - 1, ends ? first + count : first + count + 1, begins ? 1 : 0, kin,
       scale, terms);
  gather(terms, count, to.block.data());
}

}  // namespace tendril
