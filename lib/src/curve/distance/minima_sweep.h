#pragma once

#include <vector>

#include "slope.h"

/// The search behind CurveProjector::all, for one degree P: a sweep along the curve that turns certified
/// signs of the distance's slope into minima.
///
/// A curve is the sequence of its sub-pieces, each cut into stretches on whose interior the slope of the
/// squared distance has a proven sign, one proven root (a minimum or a maximum), or an unknown sign. Only
/// changes of sign between consecutive known ones count: falling, then rising, is one minimum, wherever
/// between the two it is. So a minimum at a joint, where the two sides may round to opposite signs or none,
/// is neither missed nor counted twice, and ends behave like joints to a curve that falls towards them. A
/// stretch is halved until its sign is known, down to kDoubleDepth in doubles, then to kFineDepth in
/// double-double arithmetic on points and edges formed anew from the spline; what is then left unknown is a
/// cluster of at most most_roots() critical points, reported with the best distance in it and a gap that its
/// coefficients prove.
namespace tendril::search {

struct Minimum {
  double t, distance, gap;
  bool cluster = false;
  int multiplicity = 1;
};

/// One Bezier piece of the curve in double-double arithmetic. The edges come from the derivative's own
/// control points, so that they vanish exactly where the curve has zero speed.
template <int P>
struct FinePiece {
  Polygon<P + 1, DoubleDouble> points;
  Polygon<P, DoubleDouble> edges;
  std::array<double, P> sizes;  ///< of the edges before any cancellation
};

/// The state between stretches: the last known sign of the slope, and what has been left unsigned since.
class MinimaRecorder {
 public:
  MinimaRecorder(const BSpline& curve, const Vec3& p, double cut, double blur)
      : curve_(curve), p_(p), cut_(cut), blur_(blur) {}

  /// From t on the distance falls (-1) or rises (1).
  void trend(int sign, double t) {
    if (sign_ < 0 && sign > 0) {
      if (!run_ && far_) {  // rising from what is too far already
      } else {
        close(t, std::max(1, run_ ? run_->multiplicity : 1));
      }
    } else if (run_ && run_->wide && run_->multiplicity >= (sign == sign_ ? 2 : 3)) {
      close(t, run_->multiplicity);
    }
    leave(sign, false);
  }

  /// A stretch whose slope stays unsigned; a narrow one counts as a point.
  /// \param roots  what Stretch::most_roots says
  void unsigned_stretch(double low, double high, bool wide, int roots, double least, double most) {
    if (!run_) run_ = Run{low, high, false, 0, 0, least, most};
    run_->high = high;
    run_->wide = run_->wide || wide;
    if (roots != run_->roots) run_->multiplicity += std::abs(roots);
    run_->roots = roots;
    run_->least = std::min(run_->least, least);
    run_->most = std::max(run_->most, most);
  }

  void minimum(double start, double t, double excess) {
    trend(-1, start);
    take(t, excess, false, 1);
    leave(1, false);
  }

  /// What follows is beyond the band: its sign does not matter, for no minimum there is reported.
  void beyond_band(double t) {
    if (run_ && sign_ < 0) close(t, std::max(1, run_->multiplicity));
    leave(-1, true);
  }

  std::vector<Minimum> take_all() { return std::move(found_); }

 private:
  struct Run {
    double low, high;
    bool wide;
    int multiplicity, roots;
    double least, most;  ///< of the squared distance
  };

  void leave(int sign, bool far) {
    run_.reset();
    sign_ = sign;
    far_ = far;
  }
  void close(double t, int multiplicity) {
    if (!run_) return take(t, 0.0, false, 1);
    double best = run_->low;
    for (const double other : {0.5 * (run_->low + run_->high), run_->high})
      if ((curve_.value(other) - p_).norm() < (curve_.value(best) - p_).norm()) best = other;
    take(best, run_->wide ? run_->most - run_->least : 0.0, run_->wide, run_->wide ? multiplicity : 1);
  }
  void take(double t, double excess, bool cluster, int multiplicity) {
    const double distance = (curve_.value(t) - p_).norm();
    if (!(distance <= cut_)) return;
    const double root = std::sqrt(std::max(0.0, excess));
    const double gap = (distance > root ? excess / distance : root) + 2.0 * blur_ + 8 * kUnit * distance;
    found_.push_back({t, distance, gap, cluster, multiplicity});
  }

  const BSpline& curve_;
  const Vec3 p_;
  double cut_, blur_;
  int sign_ = -1;
  bool far_ = false;
  std::optional<Run> run_;
  std::vector<Minimum> found_;
};

/// Examines sub-pieces in ascending order.
template <int P>
class Sweep {
 public:
  static constexpr int kDoubleDepth = 30, kFineDepth = 36;

  Sweep(const Vec3& p, double cut, double blur, MinimaRecorder& recorder)
      : p_(p), cut2_(cut * cut), blur_(blur), recorder_(recorder) {}

  /// \param fine  the Bezier piece the sub-piece is the `quarter`-th of `parts` of
  void examine(const Piece<P>& piece, const FinePiece<P>& fine, int quarter, int parts) {
    Stretch<P, double> whole;
    for (std::size_t i = 0; i <= P; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto k = static_cast<Eigen::Index>(c);
        whole.points[i][c] = piece.points[i][k] - p_[k];
        if (i > 0) whole.edges[i - 1][c] = piece.points[i][k] - piece.points[i - 1][k];
      }
    for (std::size_t j = 0; j < P; ++j) whole.sizes[j] = (piece.points[j + 1] - piece.points[j]).norm();
    whole.begin(blur_, 2.0 * blur_, 0.0);
    descend(whole, piece, kDoubleDepth,
            [&](const Stretch<P, double>& rest) { refine(rest, piece, fine, quarter, parts); });
  }

 private:
  template <class T, class Hand>
  void descend(const Stretch<P, T>& whole, const Piece<P>& piece, int floor, Hand&& hand_on) {
    std::array<Stretch<P, T>, kFineDepth + 2> waiting;
    std::size_t count = 1;
    waiting[0] = whole;
    while (count > 0) {
      Stretch<P, T>& stretch = waiting[count - 1];
      stretch.form();
      if (stretch.least - stretch.distance2_error > cut2_) {
        recorder_.beyond_band(piece.parameter(stretch.low));
        --count;
        continue;
      }
      const Reading reading = stretch.read();
      const bool open = reading.trend == Trend::unknown || reading.trend == Trend::noise;
      if (open && reading.trend == Trend::unknown && stretch.depth < floor) {
        waiting[count] = stretch;
        waiting[count - 1] = waiting[count].halve();
        ++count;
        continue;
      }
      --count;
      if (open) {
        hand_on(stretch);
      } else {
        report(stretch, reading, piece);
      }
    }
  }

  template <class T>
  void report(const Stretch<P, T>& stretch, const Reading& reading, const Piece<P>& piece) {
    const double start = piece.parameter(stretch.low), end = piece.parameter(stretch.high);
    const auto vague = [&](bool is, double t) {
      if (is) recorder_.unsigned_stretch(t, t, false, 0, 0.0, 0.0);
    };
    vague(reading.low_vague, start);
    if (reading.trend == Trend::down || reading.trend == Trend::up) {
      recorder_.trend(reading.trend == Trend::down ? -1 : 1, start);
    } else if (reading.trend == Trend::maximum) {
      recorder_.trend(1, start);
      recorder_.trend(-1, 0.5 * (start + end));
    } else {
      const double grain =
          4 * kUnit * std::max(std::abs(piece.begin), std::abs(piece.end)) / (piece.end - piece.begin);
      const Valley valley = bottom(stretch, grain);
      const double s = stretch.low + valley.s * (stretch.high - stretch.low);
      recorder_.minimum(start, piece.parameter(s), valley.excess);
    }
    vague(reading.high_vague, end);
  }

  /// The stretch again in double-double arithmetic, cut from the Bezier piece; what stays open is a cluster.
  void refine(const Stretch<P, double>& rest, const Piece<P>& piece, const FinePiece<P>& fine, int quarter,
              int parts) {
    Stretch<P, DoubleDouble> stretch = fine_whole(fine, parts);
    const double low = (quarter + rest.low) / parts, high = (quarter + rest.high) / parts;
    double at = 0.0;
    for (double width = 1.0; width > high - low;) {
      width *= 0.5;
      Stretch<P, DoubleDouble> right = stretch.halve();
      if (low < at + width) continue;
      at += width;
      stretch = right;
    }
    stretch.low = rest.low;
    stretch.high = rest.high;
    stretch.depth = rest.depth;
    descend(stretch, piece, kFineDepth, [&](const Stretch<P, DoubleDouble>& open) {
      recorder_.unsigned_stretch(piece.parameter(open.low), piece.parameter(open.high), true,
                                 open.most_roots(), open.least - open.distance2_error,
                                 open.most + open.distance2_error);
    });
  }

  Stretch<P, DoubleDouble> fine_whole(const FinePiece<P>& fine, int parts) const {
    Stretch<P, DoubleDouble> whole;
    double reach = 0.0;
    for (std::size_t i = 0; i <= P; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        whole.points[i][c] = fine.points[i][c] - DoubleDouble(p_[static_cast<Eigen::Index>(c)]);
        reach = std::max(reach, std::abs(fine.points[i][c].high));
      }
    for (std::size_t j = 0; j < P; ++j) {
      for (std::size_t c = 0; c < 3; ++c) whole.edges[j][c] = DoubleDouble(1.0 / parts) * fine.edges[j][c];
      whole.sizes[j] = fine.sizes[j] / parts;
    }
    constexpr double kBlossom = 24 * (P + 1) * unit_of<DoubleDouble>;
    whole.begin(2.0 * kBlossom * reach, 0.0, kBlossom);
    return whole;
  }

  const Vec3 p_;
  double cut2_, blur_;
  MinimaRecorder& recorder_;
};

/// Bezier points of a span of a spline of degree N, by blossoming: `d` holds the N + 1 control points,
/// `knots` starts at the first knot that bears on the span (2 N of them do).
template <std::size_t N, std::size_t Dim>
std::array<std::array<DoubleDouble, Dim>, N + 1> blossom_all(
    const std::array<std::array<DoubleDouble, Dim>, N + 1>& control, std::span<const double> knots) {
  std::array<std::array<DoubleDouble, Dim>, N + 1> out = control;
  for (std::size_t j = 0; j <= N; ++j) {
    auto d = control;
    for (std::size_t r = 1; r <= N; ++r) {
      const DoubleDouble x = knots[r <= j ? N : N - 1];
      for (std::size_t i = N; i >= r; --i) {
        const DoubleDouble first = knots[i - 1], last = knots[i + N - r];
        const DoubleDouble share = (x - first) / (last - first);
        for (std::size_t c = 0; c < Dim; ++c) d[i][c] = d[i - 1][c] + share * (d[i][c] - d[i - 1][c]);
      }
    }
    out[j] = d[N];
  }
  return out;
}

/// The curve's Bezier pieces in double-double arithmetic.
template <int P>
std::vector<FinePiece<P>> fine_pieces(const BSpline& curve) {
  std::vector<FinePiece<P>> pieces;
  const auto knots = curve.knots().knots();
  for (const int span : curve.knots().nonempty_spans()) {
    const auto k = static_cast<std::size_t>(span);
    const auto around = knots.subspan(k - P + 1, 2 * P);
    Polygon<P + 1, DoubleDouble> control;
    for (std::size_t i = 0; i <= P; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        control[i][c] = curve.control_points()[k - P + i][static_cast<Eigen::Index>(c)];
    // Differences times the span's length over the knots they bridge; the fourth coordinate is their size.
    std::array<std::array<DoubleDouble, 4>, P> steps;
    for (std::size_t i = 0; i < P; ++i) {
      const DoubleDouble share = (DoubleDouble(around[P]) - DoubleDouble(around[P - 1])) /
                                 (DoubleDouble(around[P + i]) - DoubleDouble(around[i]));
      steps[i][3] =
          share *
          DoubleDouble((curve.control_points()[k - P + i + 1] - curve.control_points()[k - P + i]).norm());
      for (std::size_t c = 0; c < 3; ++c) steps[i][c] = share * (control[i + 1][c] - control[i][c]);
    }
    FinePiece<P> piece;
    piece.points = blossom_all<P, 3>(control, around);
    if constexpr (P > 1) steps = blossom_all<P - 1, 4>(steps, around.subspan(1, 2 * P - 2));
    for (std::size_t j = 0; j < P; ++j) {
      std::copy(steps[j].begin(), steps[j].begin() + 3, piece.edges[j].begin());
      piece.sizes[j] = steps[j][3].high;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace tendril::search
