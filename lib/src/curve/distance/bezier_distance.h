#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/plain_vector.h"

/// The distance from a point to a Bezier piece of degree P, on plain numbers and without branches: one source
/// for the search of one point and for many points side by side in vector lanes, so that both give the same
/// bits.
///
/// Let R_i be the control points relative to the point, E_j = R_{j+1} - R_j, n = 2 P and
/// D(s) = |R(s)|^2 = sum_k D_k B_{k,n}(s). From D' = 2 R . R', R' = P sum_j E_j B_{j,P-1} and the product
/// B_{i,P} B_{j,P-1} = w_ij B_{i+j,2P-1}, w_ij = C(P,i) C(P-1,j) / C(2P-1,i+j), the differences
/// G_k = D_{k+1} - D_k, which are the coefficients of D' / n, come to
///
///   G_k = sum over i + j = k of w_ij R_i . E_j.
///
/// Error bounds, u = 2^-53 (kUnit), |R| a bound on all |R_i|, |E| on all |E_j|; the R_i count as exact. The
/// weights of one k sum to 1 (Vandermonde), so rounding is relative to |R| |E|: 1 u for the edge, 3 u for the
/// dot product, 1 u for the weight, 1 u for its product, at most 4 u for P - 1 <= 4 additions, in all 10 u
/// and second-order terms [Higham 2002]; `slope_error` is 16 u |R| |E|. Differences of the squares |R_i|^2
/// would have errors relative to |R|^2, which is useless for a short piece far away. D_k is D_0 plus k of the
/// G, all partial sums at most |R|^2: (3 + 2 P) u |R|^2 for D_0 and the additions, 2 P slope_error for the G;
/// `error` is (2 P + 4) u |R|^2 + 2 P slope_error.
///
/// So, for the exact curve with these R_i: all D >= `least` - `error`; D rises where all G_k > slope_error,
/// and falls where all are below -slope_error.
namespace tendril::search {

inline constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();

/// Times a norm: not above what the norm is without rounding.
inline constexpr double kLess = 1.0 - 4.0 * kUnit;

using lanes::larger;
using lanes::smaller;
using lanes::V3;

template <int P>
using Control = std::array<V3, P + 1>;

/// f(constant 0) ... f(constant N - 1), written out: a vector loop may hold no other.
template <std::size_t N, class F>
TENDRIL_INLINE void each(F&& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) __attribute__((always_inline)) {
    (f(std::integral_constant<std::size_t, I>{}), ...);
  }
  (std::make_index_sequence<N>{});
}

constexpr double binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

template <int P>
constexpr auto make_slope_weights() {
  std::array<std::array<double, P>, P + 1> w{};
  for (int i = 0; i <= P; ++i)
    for (int j = 0; j < P; ++j)
      w[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          binomial(P, i) * binomial(P - 1, j) / binomial(2 * P - 1, i + j);
  return w;
}
template <int P>
inline constexpr auto kSlopeWeights = make_slope_weights<P>();

/// The squared distance along a piece.
template <int P>
struct SquaredDistance {
  std::array<double, 2 * P> slope;  ///< G_k
  double first, last, least, most;  ///< D_0, D_n; smallest and largest D_k
  double reach;                     ///< bound on |R_i|
  double slope_error, error;        ///< of G_k; of D_k
};

template <int P>
TENDRIL_INLINE SquaredDistance<P> squared_distance(const Control<P>& r) {
  SquaredDistance<P> d;
  each<2 * P>([&](auto k) __attribute__((always_inline)) { d.slope[k] = 0.0; });
  double edge2 = 0.0;
  each<P>([&](auto j) __attribute__((always_inline)) {
    const V3 e = r[j + 1] - r[j];
    edge2 = larger(dot(e, e), edge2);
    each<P + 1>([&](auto i) __attribute__((always_inline)) {
      d.slope[i + j] += kSlopeWeights<P>[i][j] * dot(r[i], e);
    });
  });
  d.first = d.least = d.most = d.last = dot(r[0], r[0]);
  each<2 * P>([&](auto k) __attribute__((always_inline)) {
    d.last += d.slope[k];
    d.least = smaller(d.last, d.least);
    d.most = larger(d.last, d.most);
  });
  const double edge = std::sqrt(edge2);
  d.reach = std::sqrt(d.first) + P * edge;
  d.slope_error = 16.0 * kUnit * d.reach * edge;
  d.error = (2 * P + 4) * kUnit * d.reach * d.reach + 2 * P * d.slope_error;
  return d;
}

/// The smallest and the largest G_k.
template <int P>
TENDRIL_INLINE std::pair<double, double> slope_range(const SquaredDistance<P>& d) {
  double least = d.slope[0], most = d.slope[0];
  each<2 * P>([&](auto k) __attribute__((always_inline)) {
    least = smaller(d.slope[k], least);
    most = larger(d.slope[k], most);
  });
  return {least, most};
}

/// Lower bound on D'' when positive: D'' has the coefficients n (n - 1) (G_{k+1} - G_k), each difference with
/// an error of at most 2 slope_error and its own rounding, u times at most 2 |R| |E|: below 2.5 slope_error.
template <int P>
TENDRIL_INLINE double convexity(const SquaredDistance<P>& d) {
  double least_step = std::numeric_limits<double>::infinity();
  each<2 * P - 1>([&](auto k) __attribute__((always_inline)) {
    least_step = smaller(d.slope[k + 1] - d.slope[k], least_step);
  });
  return (2 * P) * (2 * P - 1) * (least_step - 2.5 * d.slope_error);
}

/// Value and derivatives of a Bezier curve at s.
struct Jet {
  V3 c, d1, d2;
};

template <int P>
TENDRIL_INLINE Jet jet(const Control<P>& points, double s) {
  Control<P> q = points;
  const double r = 1.0 - s;
  if constexpr (P > 2)
    each<P - 2>([&](auto level) __attribute__((always_inline)) {
      each<P - level>([&](auto i) __attribute__((always_inline)) { q[i] = r * q[i] + s * q[i + 1]; });
    });
  V3 second{0.0, 0.0, 0.0};
  if constexpr (P > 1) {
    second = static_cast<double>(P * (P - 1)) * ((q[2] - q[1]) - (q[1] - q[0]));
    q[0] = r * q[0] + s * q[1];
    q[1] = r * q[1] + s * q[2];
  }
  return {r * q[0] + s * q[1], static_cast<double>(P) * (q[1] - q[0]), second};
}

/// An approximate root of D': Newton's method on the coefficients, cheaper than on the curve. Needs
/// G_0 < 0 < G_n and ascending G.
template <std::size_t N>
TENDRIL_INLINE double guess(const std::array<double, N>& g) {
  double s = g[0] / (g[0] - g[N - 1]);
  each<3>([&](auto) __attribute__((always_inline)) {
    std::array<double, N> q = g;
    const double r = 1.0 - s;
    if constexpr (N > 2)
      each<N - 2>([&](auto level) __attribute__((always_inline)) {
        each<N - 1 - level>([&](auto k) __attribute__((always_inline)) { q[k] = r * q[k] + s * q[k + 1]; });
      });
    const double value = r * q[0] + s * q[1], rate = static_cast<double>(N - 1) * (q[1] - q[0]);
    const double next = rate > 0.0 ? s - value / rate : s;
    const double bisected = 0.5 * (s + (next < 0.5 ? 0.0 : 1.0));
    const bool inside = (next > 0.0) & (next < 1.0);
    s = inside ? next : bisected;
  });
  return s;
}

/// The root of D' / 2 = (c - p) . c' on a piece where it increases strictly: Newton's method kept inside a
/// shrinking bracket.
struct Root {
  double s;
  double low = 0.0, high = 1.0, last_step = 1.0;
  double slope = 0.0, distance = 0.0, speed = 0.0;  ///< at s: (c - p) . c', |c - p|, |c'|
  double done = 0.0;                                ///< 1 when no step is left to take
};

/// Evaluates at s, and steps on unless it is done.
template <int P>
TENDRIL_INLINE Root step(const Control<P>& points, double reach, const Root& from) {
  const Jet at = jet<P>(points, from.s);
  Root root = from;
  const double speed2 = dot(at.d1, at.d1);
  root.slope = dot(at.c, at.d1);
  root.distance = norm(at.c);
  root.speed = std::sqrt(speed2);
  root.low = root.slope < 0.0 ? from.s : from.low;
  root.high = root.slope < 0.0 ? from.high : from.s;
  const double curvature = speed2 + dot(at.c, at.d2);
  const double newton = -root.slope / larger(curvature, 0.0);  // not finite where it has no sense
  const double size = std::fabs(newton);
  const bool level = std::fabs(root.slope) <= 4.0 * kUnit * reach * (root.speed + root.distance);
  // Out of the bracket, or not halving the step: bisect.
  double next = from.s + newton;
  const bool inside = (next > root.low) & (next < root.high) & (size <= 0.5 * std::fabs(from.last_step));
  next = inside ? next : 0.5 * (root.low + root.high);
  const bool done = (size <= 1e-15) | ((size < 1e-3) & level) | (next <= root.low) | (next >= root.high);
  root.done = done ? 1.0 : 0.0;
  root.last_step = done ? from.last_step : next - from.s;
  root.s = done ? from.s : next;
  return root;
}

/// Proven: no distance on the piece is smaller. D is convex with D'' >= m, m the convexity, and its minimum
/// lies in the bracket, so D(x) >= D(s) + D'(s) (x - s) + m / 2 (x - s)^2 gives D >= D(s) - |D'(s)| width
/// and, at the minimum of the right side over x, D >= D(s) - D'(s)^2 / (2 m).
///
/// D'(s) / 2 = c . c' as evaluated has an error: de Casteljau's scheme gives c to 8 P u reach and c', P times
/// differences of points, to P times that, so |c| times the one and |c'| times the other are added. The
/// square is lowered by its own rounding (kLess), the root by the error of c.
template <int P>
TENDRIL_INLINE double lower_bound(const Root& root, double reach, double convexity) {
  const double speed_error = 8.0 * P * kUnit * P * reach;
  const double slope =
      2.0 * (std::fabs(root.slope) + root.distance * speed_error + 8.0 * P * kUnit * reach * root.speed);
  const double drop = smaller(slope * (root.high - root.low), slope * slope / (2.0 * convexity));
  const double square = root.distance * root.distance * kLess - drop;
  return std::sqrt(larger(square, 0.0)) - 4.0 * P * kUnit * reach;
}

}  // namespace tendril::search
