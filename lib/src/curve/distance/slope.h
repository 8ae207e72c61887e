#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "distance_search.h"
#include "double_double.h"

/// The slope of the squared distance along a stretch of curve, with certified signs, in double or
/// double-double arithmetic.
///
/// With R_i the control points relative to the point projected and H_j the edges of the whole sub-piece's
/// control polygon, restricted to the stretch, half the derivative of |R|^2 has the Bernstein coefficients
/// G_k = P sum_{i+j=k} w_ij R_i . H_j of degree 2 P - 1 (the factor P is left out here). Points and edges are
/// halved side by side, and the edges' sizes with them, so that the error stays relative to |R| |H| however
/// short the stretch is, and however slow the curve is there.
///
/// Error of G_k, with u the unit of T: 24 u |R| |H| covers the sum as in bezier_distance.h. A halving makes
/// at most P roundings of a point and P - 1 of an edge, each relative to the polygon before it, which the
/// sizes follow: 4 P u |R| |H| a level. What points and edges come with enters as blur |H| (points), and
/// doubt |R| + uncertain |R| |H| (edges, absolute and relative).
namespace tendril::search {

template <class T>
using Triple = std::array<T, 3>;

/// A polygon of N points in arithmetic T.
template <std::size_t N, class T>
using Polygon = std::array<Triple<T>, N>;

/// Halves a Bezier polygon (de Casteljau): keeps the left half, returns the right.
template <std::size_t N, class T>
Polygon<N, T> halve(Polygon<N, T>& points) {
  Polygon<N, T> right = points;
  for (std::size_t n = N - 1; n > 0; --n) {
    points[N - 1 - n] = right[0];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < 3; ++c) right[i][c] = T(0.5) * (right[i][c] + right[i + 1][c]);
  }
  points[N - 1] = right[0];
  return right;
}

template <std::size_t N, class T>
T bernstein(std::array<T, N> g, double s) {
  const T at = T(s), rest = T(1.0) - T(s);
  for (std::size_t n = N - 1; n > 0; --n)
    for (std::size_t k = 0; k < n; ++k) g[k] = rest * g[k] + at * g[k + 1];
  return g[0];
}

/// What the signs of a slope prove on the open stretch.
enum class Trend { down, up, minimum, maximum, unknown, noise };

struct Reading {
  Trend trend;                 ///< noise: no coefficient has a certain sign
  bool low_vague, high_vague;  ///< the sign may change within 1e-9 of a sub-piece from an end
};

template <int P, class T>
struct Stretch {
  static constexpr std::size_t kCount = 2 * P;
  static constexpr double kNarrow = 1e-9;  ///< of a sub-piece: roots closer to an end count as being there

  Polygon<P + 1, T> points;
  Polygon<P, T> edges;
  std::array<double, P> sizes;  ///< of the edges, halved like them: what their rounding is relative to
  double low, high;             ///< in the sub-piece's [0, 1]; dyadic, hence exact
  int depth;
  double blur;              ///< error of the points
  double doubt, uncertain;  ///< of the edges: absolute, and relative to their sizes

  std::array<T, kCount> slope;
  std::array<double, kCount> g;         ///< slope, rounded
  double error;                         ///< of each slope coefficient
  double least, most, distance2_error;  ///< of the squared distance's coefficients

  void form() {
    slope.fill(T(0.0));
    double reach2 = 0.0;
    for (std::size_t i = 0; i <= P; ++i) reach2 = std::max(reach2, square(points[i]));
    for (std::size_t j = 0; j < P; ++j)
      for (std::size_t i = 0; i <= P; ++i)
        slope[i + j] += T(binomial(P, static_cast<int>(i)) * binomial(P - 1, static_cast<int>(j))) *
                        dot(points[i], edges[j]);
    const double reach = std::sqrt(reach2), size = *std::max_element(sizes.begin(), sizes.end());
    error = ((24 + 4 * P * depth) * unit_of<T> + uncertain) * reach * size + blur * size + doubt * reach;
    double d = least = most = square(points[0]);
    for (std::size_t k = 0; k < kCount; ++k) {
      slope[k] = slope[k] / T(binomial(2 * P - 1, static_cast<int>(k)));
      g[k] = to_double(slope[k]);
      d += g[k] * (high - low);
      least = std::min(least, d);
      most = std::max(most, d);
    }
    distance2_error = (4 * P + 8) * kUnit * reach2 + 2 * P * (high - low) * error + 4.0 * blur * reach;
  }

  Stretch halve() {
    Stretch right = *this;
    right.points = search::halve(points);
    right.edges = search::halve(edges);
    right.sizes = sizes;
    for (std::size_t n = P - 1; n > 0; --n) {
      sizes[P - 1 - n] = right.sizes[0];
      for (std::size_t i = 0; i < n; ++i) right.sizes[i] = 0.5 * (right.sizes[i] + right.sizes[i + 1]);
    }
    sizes[P - 1] = right.sizes[0];
    right.low = high = 0.5 * (low + high);
    right.depth = ++depth;
    return right;
  }

  /// To be called once points, edges and sizes are those of the whole sub-piece.
  void begin(double points_error, double edges_error, double edges_relative_error) {
    low = 0.0;
    high = 1.0;
    depth = 0;
    double reach = 0.0;
    for (const auto& point : points) reach = std::max(reach, std::sqrt(square(point)));
    blur = points_error + 4 * P * unit_of<T> * reach;
    doubt = edges_error;
    uncertain = edges_relative_error;
  }

  /// Smallest and largest difference of neighbouring slope coefficients.
  std::pair<double, double> bend() const {
    double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
    for (std::size_t k = 0; k + 1 < kCount; ++k) {
      const double difference = to_double(slope[k + 1] - slope[k]);
      smallest = std::min(smallest, difference);
      largest = std::max(largest, difference);
    }
    return {smallest, largest};
  }

  Reading read() const {
    std::size_t first = 0, last = kCount - 1;
    while (first < kCount && sign(first) == 0) ++first;
    if (first == kCount) return {Trend::noise, true, true};
    while (sign(last) == 0) --last;
    const Reading vague{Trend::unknown, first > 0, last + 1 < kCount};
    if (!narrow(first, g[first]) || !narrow(kCount - 1 - last, g[last])) return vague;
    return {body(first, last), vague.low_vague, vague.high_vague};
  }

  /// At most so many roots of the slope: the order of the first difference whose sign is certain (Rolle),
  /// with that sign. Neighbours with the same answer share it.
  int most_roots() const {
    std::array<T, kCount> d = slope;
    double e = error;
    for (std::size_t k = 0; k + 1 < kCount; ++k) {
      const auto end = d.begin() + static_cast<std::ptrdiff_t>(kCount - k);
      for (const int sign : {1, -1})
        if (std::all_of(d.begin(), end, [&](const T& x) { return sign * to_double(x) > e; }))
          return sign * static_cast<int>(k);
      for (std::size_t i = 0; i + k + 1 < kCount; ++i) d[i] = d[i + 1] - d[i];
      e *= 2.5;
    }
    return static_cast<int>(kCount) - 1;
  }

  static double square(const Triple<T>& a) {
    const double x = to_double(a[0]), y = to_double(a[1]), z = to_double(a[2]);
    return x * x + y * y + z * z;
  }

 private:
  static T dot(const Triple<T>& a, const Triple<T>& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  int sign(std::size_t k) const { return g[k] > error ? 1 : g[k] < -error ? -1 : 0; }

  /// Whether uncertain signs at an end matter only within kNarrow of it. The first `count` coefficients there
  /// add up to at most `error`; the next one, of size |value|, contributes at least
  /// |value| C(n, count) s^count (1 - s)^n, n = 2 P - 1. So the slope has its sign where that is more than
  /// error; for s < 0.1, (1 - s)^n >= 0.9^9 > 1 / 3, so from s^count = 3 error / (|value| C(n, count)) on.
  bool narrow(std::size_t count, double value) const {
    if (count == 0) return true;
    const double share = 3.0 * error / (std::abs(value) * binomial(2 * P - 1, static_cast<int>(count)));
    const double width = std::pow(share, 1.0 / static_cast<double>(count));
    return width < 0.1 && width * (high - low) < kNarrow;
  }

  Trend body(std::size_t first, std::size_t last) const {
    int changes = 0, before = sign(first);
    bool certain = true;
    for (std::size_t k = first + 1, unsigned_ones = 0; k <= last; ++k) {
      const int now = sign(k);
      if (now == 0) {
        ++unsigned_ones;
        continue;
      }
      if (now != before) ++changes;
      if (unsigned_ones > (now != before ? 1U : 0U)) certain = false;
      unsigned_ones = 0;
      before = now;
    }
    if (changes == 0 && certain) return before > 0 ? Trend::up : Trend::down;
    const auto [smallest, largest] = bend();
    // In doubles a valley must be firm enough to place its bottom to 1e-7 of the stretch.
    const double firm = std::is_same_v<T, double> ? 1e7 : 2.5;
    if (sign(first) < 0 && before > 0) return smallest > firm * error ? Trend::minimum : Trend::unknown;
    if (sign(first) > 0 && before < 0 && ((changes == 1 && certain) || largest < -2.5 * error))
      return Trend::maximum;
    return Trend::unknown;
  }
};

/// The root of an ascending slope: where, and a bound on how much the squared distance there exceeds its
/// least when s is rounded to a multiple of `grain`, in the sub-piece's unit.
///
/// Over the stretch, of width w in that unit and n = 2 P, dD = n w G(s) ds and D'' lies between n (n - 1) w
/// times the smallest and the largest difference of the G. With g = |G(s)| + error the excess is at most n w
/// min(g, g^2 / (2 (n - 1) smallest)), as in lower_bound(); a rounding of grain / w adds at most half of D''
/// times its square, n^2 largest grain^2 / w.
struct Valley {
  double s, excess;
};

template <int P, class T>
Valley bottom(const Stretch<P, T>& stretch, double grain) {
  double low = 0.0, high = 1.0, s = guess(stretch.g), value = 0.0, last_step = 1.0;
  std::array<double, 2 * P - 1> rates;
  for (std::size_t k = 0; k + 1 < 2 * P; ++k) rates[k] = stretch.g[k + 1] - stretch.g[k];
  for (int i = 0; i < 120; ++i) {
    value = to_double(bernstein(stretch.slope, s));
    (value < 0.0 ? low : high) = s;
    const double rate = (2 * P - 1) * bernstein(rates, s);
    const double step = rate > 0.0 ? -value / rate : 2.0;
    if (std::abs(step) <= 1e-16 || value == 0.0) break;
    double next = s + step;
    if (!(next > low && next < high) || std::abs(step) > 0.5 * std::abs(last_step)) next = 0.5 * (low + high);
    if (next <= low || next >= high) break;
    last_step = next - s;
    s = next;
  }
  const double width = stretch.high - stretch.low, n = 2 * P;
  const auto [smallest, largest] = stretch.bend();
  const double slope = std::abs(value) + stretch.error;
  return {s, n * width * std::min(slope, slope * slope / (2 * (n - 1) * (smallest - 2 * stretch.error))) +
                 n * n * (largest + 2 * stretch.error) * grain * grain / width};
}

}  // namespace tendril::search
