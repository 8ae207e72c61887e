#pragma once

#include <tendril/curve/bspline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bezier_distance.h"

/// The search behind CurveProjector, for one degree P.
///
/// What is proven here is proven for the curve with control points R_i = fl(B_i - p), as doubles; the caller
/// adds the distance `blur` between that curve and the one it evaluates.
namespace tendril::search {

inline constexpr int kMaxDepth = 50;
inline constexpr int kMaxSteps = 120;

/// Shares of a search that do not depend on the degree.
struct Bounds {
  double flat;   ///< a sub-piece whose distance varies less is resolved
  double slack;  ///< margin of every rejection: far above rounding, so that the outcome does not depend on
                 ///< the bound a search started from
  double blur;   ///< distance between the local curve and BSpline::value
  double proof;  ///< a root is resolved when the bound on the distances around it is so close
};

/// One Bezier sub-piece.
template <int P>
struct Piece {
  std::array<Vec3, P + 1> points;
  double begin, end;  ///< parameters

  double parameter(double s) const { return s == 0.0 ? begin : s == 1.0 ? end : begin + s * (end - begin); }
};

inline V3 plain(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <int P>
TENDRIL_INLINE Control<P> relative(const Piece<P>& piece, const Vec3& p) {
  Control<P> points;
  for (std::size_t i = 0; i <= P; ++i)
    points[i] = {piece.points[i].x() - p.x(), piece.points[i].y() - p.y(), piece.points[i].z() - p.z()};
  return points;
}

/// A parameter interval of a sub-piece under examination, and its squared distance polynomial.
template <int P>
struct Interval : SquaredDistance<P> {
  Control<P> points;  ///< relative to the point projected
  double low, high;   ///< in the sub-piece's [0, 1]; dyadic, hence exact
  int depth;

  void form() { static_cast<SquaredDistance<P>&>(*this) = squared_distance<P>(points); }

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

template <int P>
Root at_end(const Interval<P>& interval, double s) {
  const Jet at = jet<P>(interval.points, s);
  Root root{s};
  root.distance = norm(at.c);
  root.speed = norm(at.d1);
  return root;
}

/// The root of D' on an interval where it increases strictly, or the end it points to.
template <int P>
Root stationary(const Interval<P>& interval) {
  if (interval.slope.front() >= 0.0) return at_end(interval, 0.0);
  if (interval.slope.back() <= 0.0) return at_end(interval, 1.0);
  Root root{guess(interval.slope)};
  for (int i = 0; i < kMaxSteps && root.done == 0.0; ++i)
    root = step<P>(interval.points, interval.reach, root);
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
    root.points = relative<P>(piece, p_);
    root.low = 0.0;
    root.high = 1.0;
    root.depth = 0;
    while (count > 0) {
      Interval<P>& interval = waiting[count - 1];
      interval.form();
      if (dropped(interval) || resolved(piece, interval)) {
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

  bool resolved(const Piece<P>& piece, const Interval<P>& interval) {
    const auto [least_slope, most_slope] = slope_range<P>(interval);
    if (least_slope > interval.slope_error) return take_end(piece, interval.low, interval.points.front());
    if (most_slope < -interval.slope_error) return take_end(piece, interval.high, interval.points.back());
    if (const double bend = convexity<P>(interval); bend > 0.0 && take_root(piece, interval, bend))
      return true;
    const double least = std::sqrt(std::max(0.0, interval.least));
    if (std::sqrt(interval.most) - least > bounds_.flat && interval.depth < kMaxDepth) return false;
    evaluate(piece.parameter(interval.low));
    evaluate(piece.parameter(interval.high));
    prove(std::sqrt(std::max(0.0, interval.least - interval.error)));
    return true;
  }

  bool take_end(const Piece<P>& piece, double s, const V3& offset) {
    const double distance = norm(offset);
    candidate(piece.parameter(s), distance);
    prove(distance * kLess);
    return true;
  }

  bool take_root(const Piece<P>& piece, const Interval<P>& interval, double bend) {
    const Root root = stationary<P>(interval);
    const double least = lower_bound<P>(root, interval.reach, bend);
    if (root.distance - least > bounds_.proof && interval.depth < kMaxDepth) return false;
    candidate(piece.parameter(interval.parameter(root.s)), root.distance);
    prove(least);
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
