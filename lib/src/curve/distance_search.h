#pragma once

#include <tendril/curve/bspline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// The search behind CurveProjector, for one degree P.
///
/// What is proven here is proven for the curve with control points R_i = fl(B_i - p), as doubles; the caller
/// adds the distance `blur` between that curve and the one it evaluates. With n = 2 P and
/// D(s) = |R(s)|^2 = sum_k D_k B_{k,n}(s), the differences G_k = D_{k+1} - D_k are
/// G_k = sum_{i+j=k} w_ij R_i . (R_{j+1} - R_j), w_ij = C(P,i) C(P-1,j) / C(2P-1,k): formed in this way their
/// errors are relative to |R| |E| (E: the largest edge of the control polygon), not to |R|^2.
namespace tendril::search {

inline constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();
inline constexpr int kMaxDepth = 50;

/// Shares of a search that do not depend on the degree.
struct Bounds {
  double flat;   ///< a sub-piece whose distance varies less is settled
  double slack;  ///< margin of every rejection: far above rounding, so that the outcome does not depend on
                 ///< the bound a search started from
  double blur;   ///< distance between the local curve and BSpline::value
};

/// One Bezier sub-piece.
template <int P>
struct Piece {
  std::array<Vec3, P + 1> points;
  double begin, end;  ///< parameters

  double parameter(double s) const { return s == 0.0 ? begin : s == 1.0 ? end : begin + s * (end - begin); }
};

constexpr double binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

template <int P>
constexpr auto slope_weights() {
  std::array<std::array<double, P>, P + 1> w{};
  for (int i = 0; i <= P; ++i)
    for (int j = 0; j < P; ++j)
      w[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          binomial(P, i) * binomial(P - 1, j) / binomial(2 * P - 1, i + j);
  return w;
}

/// Value and derivatives of a Bezier curve at s.
struct Jet {
  Vec3 c, d1, d2;
};

template <int P>
Jet jet(const std::array<Vec3, P + 1>& points, double s) {
  std::array<Vec3, P + 1> q = points;
  const double r = 1.0 - s;
  for (std::size_t n = P; n > 2; --n)
    for (std::size_t i = 0; i < n; ++i) q[i] = r * q[i] + s * q[i + 1];
  Vec3 second = Vec3::Zero();
  if constexpr (P > 1) {
    second = (P * (P - 1)) * ((q[2] - q[1]) - (q[1] - q[0]));
    q[0] = r * q[0] + s * q[1];
    q[1] = r * q[1] + s * q[2];
  }
  return {r * q[0] + s * q[1], P * (q[1] - q[0]), second};
}

/// A parameter interval of a sub-piece under examination, and its squared distance polynomial.
template <int P>
struct Interval {
  std::array<Vec3, P + 1> points;  ///< relative to the point projected
  double low, high;                ///< in the sub-piece's [0, 1]; dyadic, hence exact
  int depth;

  std::array<double, 2 * P> slope;  ///< G_k
  double first, last, least, most;  ///< D_0, D_n; smallest and largest D_k
  double reach;                     ///< bound on |R_i|
  double slope_error, error;        ///< of G_k; of D_k

  void form() {
    static constexpr auto w = slope_weights<P>();
    slope.fill(0.0);
    double edge2 = 0.0;
    for (std::size_t j = 0; j < P; ++j) {
      const Vec3 e = points[j + 1] - points[j];
      edge2 = std::max(edge2, e.squaredNorm());
      for (std::size_t i = 0; i <= P; ++i) slope[i + j] += w[i][j] * points[i].dot(e);
    }
    first = least = most = last = points[0].squaredNorm();
    for (const double g : slope) {
      last += g;
      least = std::min(least, last);
      most = std::max(most, last);
    }
    const double edge = std::sqrt(edge2);
    reach = std::sqrt(first) + P * edge;
    slope_error = 16.0 * kUnit * reach * edge;
    error = (2 * P + 4) * kUnit * reach * reach + 2 * P * slope_error;
  }

  bool increasing() const {
    return std::all_of(slope.begin(), slope.end(), [&](double g) { return g > slope_error; });
  }
  bool decreasing() const {
    return std::all_of(slope.begin(), slope.end(), [&](double g) { return g < -slope_error; });
  }
  /// Lower bound on D'' when positive.
  double convexity() const {
    double least_step = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < 2 * P; ++k) least_step = std::min(least_step, slope[k + 1] - slope[k]);
    return (2 * P) * (2 * P - 1) * (least_step - 2.5 * slope_error);
  }
  double parameter(double s) const { return s == 0.0 ? low : s == 1.0 ? high : low + s * (high - low); }

  /// Halves: keeps the left, returns the right (de Casteljau).
  Interval halve() {
    Interval right = *this;
    right.low = high = 0.5 * (low + high);
    right.depth = ++depth;
    for (std::size_t n = P; n > 0; --n) {
      points[P - n] = right.points[0];
      for (std::size_t i = 0; i < n; ++i) right.points[i] = 0.5 * (right.points[i] + right.points[i + 1]);
    }
    points[P] = right.points[0];
    return right;
  }
};

/// A place near the root of sum_k g_k B_k(s): Newton's method on these scalars, cheaper than on the curve.
/// Needs g_0 < 0 < g_n and ascending g.
template <std::size_t N>
double guess(const std::array<double, N>& g) {
  double s = g.front() / (g.front() - g.back());
  for (int i = 0; i < 3; ++i) {
    std::array<double, N> q = g;
    const double r = 1.0 - s;
    for (std::size_t n = N - 1; n > 1; --n)
      for (std::size_t k = 0; k < n; ++k) q[k] = r * q[k] + s * q[k + 1];
    const double value = r * q[0] + s * q[1], rate = static_cast<double>(N - 1) * (q[1] - q[0]);
    const double next = rate > 0.0 ? s - value / rate : s;
    const double step = std::abs(next - s);
    s = next > 0.0 && next < 1.0 ? next : 0.5 * (s + (next < 0.5 ? 0.0 : 1.0));
    if (step < 1e-6) break;
  }
  return s;
}

/// Root of (c - p) . c' on an interval where it increases strictly, or the end it points to.
/// Newton's method kept inside a shrinking bracket.
struct Root {
  double s, slope, width;  ///< slope: (c - p) . c' at s; width: of the bracket left
  Jet at;
};

template <int P>
Root stationary(const Interval<P>& interval) {
  const double g0 = interval.slope.front(), gn = interval.slope.back();
  if (g0 >= 0.0) return {0.0, 0.0, 1.0, jet<P>(interval.points, 0.0)};
  if (gn <= 0.0) return {1.0, 0.0, 1.0, jet<P>(interval.points, 1.0)};
  double low = 0.0, high = 1.0, s = guess(interval.slope), last_step = 1.0;
  Root root{s, 0.0, 1.0, {}};
  for (int i = 0; i < 120; ++i) {
    root.at = jet<P>(interval.points, s);
    root.s = s;
    root.slope = root.at.c.dot(root.at.d1);
    (root.slope < 0.0 ? low : high) = s;
    const double curvature = root.at.d1.squaredNorm() + root.at.c.dot(root.at.d2);
    const double step = curvature > 0.0 ? -root.slope / curvature : 2.0;
    if (std::abs(step) <= 1e-15) break;
    if (std::abs(step) < 1e-3 &&
        std::abs(root.slope) <= 4.0 * kUnit * interval.reach * (root.at.d1.norm() + root.at.c.norm()))
      break;
    // Out of the bracket, or not halving the step: bisect.
    double next = s + step;
    if (!(next > low && next < high) || std::abs(step) > 0.5 * std::abs(last_step)) next = 0.5 * (low + high);
    if (next <= low || next >= high) break;
    last_step = next - s;
    s = next;
  }
  root.width = high - low;
  return root;
}

/// One search: the candidates met, compared by their evaluated distance, and the least distance not excluded.
template <int P>
class Search {
 public:
  Search(const BSpline& curve, const Vec3& p, const Bounds& bounds) : curve_(curve), p_(p), bounds_(bounds) {}

  double cut() const { return cut_; }
  /// Compares the candidates left; what follows is asked for afterwards.
  void finish() {
    std::size_t left = 0;
    for (std::size_t i = 0; i < waiting_; ++i)
      if (candidates_[i].local <= cut_) candidates_[left++] = candidates_[i];
    waiting_ = left;
    if (left == 1 && std::isinf(distance_))
      t_ = candidates_[0].t;  // nothing to compare with
    else
      compare();
  }
  double t() const { return t_; }
  double least() const { return proven_; }

  void examine(const Piece<P>& piece) {
    // Right halves wait; depth first leaves at most one per level.
    std::array<Interval<P>, kMaxDepth + 1> waiting;
    std::size_t count = 1;
    Interval<P>& root = waiting[0];
    for (std::size_t i = 0; i <= P; ++i) root.points[i] = piece.points[i] - p_;
    root.low = 0.0;
    root.high = 1.0;
    root.depth = 0;
    while (count > 0) {
      Interval<P>& interval = waiting[count - 1];
      interval.form();
      if (dropped(interval) || settled(piece, interval)) {
        --count;
        continue;
      }
      Interval<P> right = interval.halve();
      waiting[count] = interval;
      waiting[count - 1] = right;
      ++count;
    }
  }

 private:
  bool dropped(const Interval<P>& interval) {
    if (interval.least - interval.error > cut_ * cut_) return true;
    lower_cut(std::sqrt(std::max(0.0, std::min(interval.first, interval.last + interval.error))));
    return false;
  }

  bool settled(const Piece<P>& piece, const Interval<P>& interval) {
    if (interval.increasing()) return take_end(piece, interval.low, interval.points.front());
    if (interval.decreasing()) return take_end(piece, interval.high, interval.points.back());
    if (const double convexity = interval.convexity(); convexity > 0.0)
      return take_root(piece, interval, convexity);
    const double least = std::sqrt(std::max(0.0, interval.least));
    if (std::sqrt(interval.most) - least > bounds_.flat && interval.depth < kMaxDepth) return false;
    evaluate(piece.parameter(interval.low));
    evaluate(piece.parameter(interval.high));
    prove(std::sqrt(std::max(0.0, interval.least - interval.error)));
    return true;
  }

  bool take_end(const Piece<P>& piece, double s, const Vec3& offset) {
    const double distance = offset.norm();
    candidate(piece.parameter(s), distance);
    prove(distance * (1.0 - 4.0 * kUnit));
    return true;
  }

  /// D is convex with D'' >= convexity, so D >= D(s) - |D'(s)| width and D >= D(s) - D'(s)^2 / (2 convexity).
  bool take_root(const Piece<P>& piece, const Interval<P>& interval, double convexity) {
    const Root root = stationary<P>(interval);
    const double distance = root.at.c.norm();
    candidate(piece.parameter(interval.parameter(root.s)), distance);
    const double speed_error = 8.0 * P * kUnit * P * interval.reach;
    const double slope = 2.0 * (std::abs(root.slope) + distance * speed_error +
                                8.0 * P * kUnit * interval.reach * root.at.d1.norm());
    const double drop = std::min(slope * root.width, slope * slope / (2.0 * convexity));
    prove(std::sqrt(std::max(0.0, distance * distance * (1.0 - 4.0 * kUnit) - drop)) -
          4.0 * P * kUnit * interval.reach);
    return true;
  }

  /// \param local  the distance on the local curve: one beyond the cut needs no evaluation, and until the end
  /// of the search the cut may still fall
  void candidate(double t, double local) {
    if (local > cut_) return;
    if (waiting_ == candidates_.size()) compare();
    candidates_[waiting_++] = {t, local};
    lower_cut(local);
  }

  void compare() {
    for (std::size_t i = 0; i < waiting_; ++i) evaluate(candidates_[i].t);
    waiting_ = 0;
  }

  void evaluate(double t) {
    const double d = (curve_.value(t) - p_).norm();
    if (d < distance_ || (d == distance_ && t < t_)) {
      distance_ = d;
      t_ = t;
    }
    lower_cut(d);
  }

  void prove(double lower) { proven_ = std::min(proven_, lower - bounds_.blur); }
  void lower_cut(double upper) { cut_ = std::min(cut_, upper + bounds_.slack); }

  const BSpline& curve_;
  const Vec3 p_;
  const Bounds bounds_;
  double distance_ = std::numeric_limits<double>::infinity();
  double t_ = std::numeric_limits<double>::infinity();
  double proven_ = std::numeric_limits<double>::infinity();
  double cut_ = std::numeric_limits<double>::infinity();
  struct Candidate {
    double t, local;
  };
  std::array<Candidate, 8> candidates_;
  std::size_t waiting_ = 0;
};

}  // namespace tendril::search
