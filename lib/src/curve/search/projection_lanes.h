#pragma once

#include <tendril/curve/knots.h>

#include "curve/basis_rows.h"
#include "curve/distance/bezier_distance.h"

/// Searches of many points side by side: the arithmetic of distance_search.h and of BSpline, a row of lanes
/// for each number. What a lane cannot resolve it says, and the search of one point does.
namespace tendril::search {

inline constexpr std::size_t kLanes = 32;

/// One number of every lane.
using Lanes = double[kLanes];

/// What became of a piece in a lane.
namespace fate {
inline constexpr double dropped = 0.0,  ///< farther than the cut
    start = 1.0,                        ///< the distance increases: nearest at the piece's start
    end = 2.0,                          ///< decreases
    root = 3.0,                         ///< strictly convex: nearest at s
    open = 4.0;                         ///< none of these is proven
}

template <int P>
struct alignas(64) PieceLanes {
  Lanes x[P + 1], y[P + 1], z[P + 1];  ///< in: control points relative to the point
  Lanes cut;                           ///< in: greatest distance that counts
  Lanes fate;                          ///< out: one of the above
  Lanes s, distance, least;            ///< out: the nearest; a proven lower bound on the piece
  Lanes upper;                         ///< out: a distance that the piece attains
  Lanes root, low, high, last_step, slope, root_distance, speed, reach, bend, done;
};

template <int P>
TENDRIL_INLINE Control<P> control(const PieceLanes<P>& lanes, std::size_t i) {
  Control<P> r;
  each<P + 1>([&](auto k) __attribute__((always_inline)) {
    r[k] = {lanes.x[k][i], lanes.y[k][i], lanes.z[k][i]};
  });
  return r;
}

/// First half of a resolution: fates, ends, and where to look for roots.
template <int P>
TENDRIL_LANES void measure(PieceLanes<P>& lanes, std::size_t count) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const Control<P> r = control<P>(lanes, i);
    const SquaredDistance<P> d = squared_distance<P>(r);
    const auto [least_slope, most_slope] = slope_range<P>(d);
    const double bend = convexity<P>(d);
    const double front = d.slope[0], back = d.slope[2 * P - 1];
    const bool rooted = (bend > 0.0) & (front < 0.0) & (back > 0.0);
    double which = rooted ? fate::root : fate::open;
    which = most_slope < -d.slope_error ? fate::end : which;
    which = least_slope > d.slope_error ? fate::start : which;
    which = d.least - d.error > lanes.cut[i] * lanes.cut[i] ? fate::dropped : which;
    const double ends = larger(smaller(d.first, d.last + d.error), 0.0);
    const double distance = norm(which == fate::end ? r[P] : r[0]);
    lanes.fate[i] = which;
    lanes.upper[i] = std::sqrt(ends);
    lanes.s[i] = which == fate::end ? 1.0 : 0.0;
    lanes.distance[i] = distance;
    lanes.least[i] = distance * kLess;
    lanes.root[i] = guess(d.slope);
    lanes.low[i] = 0.0;
    lanes.high[i] = lanes.last_step[i] = 1.0;
    lanes.reach[i] = d.reach;
    lanes.bend[i] = bend;
  }
}

/// One step of every root: one that is done stays. Returns whether all are.
template <int P>
TENDRIL_LANES bool advance(PieceLanes<P>& lanes, std::size_t count) {
  double least_done = 1.0;
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const Root from{lanes.root[i], lanes.low[i], lanes.high[i], lanes.last_step[i]};
    const Root to = step<P>(control<P>(lanes, i), lanes.reach[i], from);
    lanes.root[i] = to.s;
    lanes.low[i] = to.low;
    lanes.high[i] = to.high;
    lanes.last_step[i] = to.last_step;
    lanes.slope[i] = to.slope;
    lanes.root_distance[i] = to.distance;
    lanes.speed[i] = to.speed;
    lanes.done[i] = lanes.fate[i] == fate::root ? to.done : 1.0;
  }
  for (std::size_t i = 0; i < count; ++i) least_done = smaller(lanes.done[i], least_done);
  return least_done == 1.0;
}

template <int P>
TENDRIL_LANES void take_roots(PieceLanes<P>& lanes, std::size_t count) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    const Root root{lanes.root[i],  lanes.low[i],           lanes.high[i],  lanes.last_step[i],
                    lanes.slope[i], lanes.root_distance[i], lanes.speed[i], 1.0};
    const double least = lower_bound<P>(root, lanes.reach[i], lanes.bend[i]);
    const bool taken = lanes.fate[i] == fate::root;
    lanes.s[i] = taken ? root.s : lanes.s[i];
    lanes.distance[i] = taken ? root.distance : lanes.distance[i];
    lanes.least[i] = taken ? least : lanes.least[i];
    lanes.fate[i] = lanes.done[i] != 0.0 ? lanes.fate[i] : fate::open;
  }
}

template <int P>
void resolve(PieceLanes<P>& lanes, std::size_t count) {
  constexpr int kSteps = 4;  // nearly all roots take one or two
  measure<P>(lanes, count);
  for (int k = 0; k < kSteps; ++k)
    if (advance<P>(lanes, count)) break;
  take_roots<P>(lanes, count);
}

/// The curve at one parameter a lane, and what describes a projection there.
template <int P>
struct alignas(64) CurveLanes {
  Lanes t, px, py, pz;                 ///< in: parameter and point projected
  Lanes knot[2 * P];                   ///< in: those that the span's basis functions ask for
  Lanes x[P + 1], y[P + 1], z[P + 1];  ///< in: control points of the span
  Lanes cx, cy, cz, distance, lambda;  ///< out
  Lanes speed;                         ///< out: |c'|
};

template <int P>
TENDRIL_INLINE V3 combine(const CurveLanes<P>& lanes, std::size_t i, const basis::Row& weight) {
  const auto point = [&](auto k) __attribute__((always_inline)) {
    return V3{lanes.x[k][i], lanes.y[k][i], lanes.z[k][i]};
  };
  V3 sum = weight[0] * point(std::integral_constant<std::size_t, 0>{});
  each<P>([&](auto k) __attribute__((always_inline)) {
    sum = sum + weight[k + 1] * point(std::integral_constant<std::size_t, k + 1>{});
  });
  return sum;
}

template <int P>
TENDRIL_LANES void describe(CurveLanes<P>& lanes, std::size_t count) {
  TENDRIL_LOOP
  for (std::size_t i = 0; i < count; ++i) {
    double knots[2 * P];
    each<2 * P>([&](auto k) __attribute__((always_inline)) { knots[k] = lanes.knot[k][i]; });
    const double* knot = knots + (P - 1);
    basis::Rows rows;
    rows[0] = basis::Row{1.0};
    basis::fill_values<P>(rows, knot, lanes.t[i]);
    const V3 c = combine<P>(lanes, i, rows[P]);
    const V3 d1 = combine<P>(lanes, i, basis::differentiate<P, P - 1>(rows[P - 1], knot));
    V3 d2{0.0, 0.0, 0.0};
    if constexpr (P >= 2) d2 = combine<P>(lanes, i, basis::differentiate<P, P - 2>(rows[P - 2], knot));
    const V3 offset = c - V3{lanes.px[i], lanes.py[i], lanes.pz[i]};
    lanes.cx[i] = c.x;
    lanes.cy[i] = c.y;
    lanes.cz[i] = c.z;
    lanes.distance[i] = norm(offset);
    lanes.lambda[i] = 1.0 + dot(offset, d2) / dot(d1, d1);
    lanes.speed[i] = norm(d1);
  }
}

}  // namespace tendril::search
