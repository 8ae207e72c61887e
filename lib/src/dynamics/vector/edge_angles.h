#pragma once

#include "lanes.h"

namespace tendril {

/// Angles of a unit edge against a node frame, as the bending springs see them: the turn from the frame's
/// tangent to the edge, phi up to half a turn, split into those towards l and m, l = r x and m = r y with
/// r = phi / sin(phi).
struct EdgeAngles {
  double x, y, z;  ///< components e.l, e.m, e.t
  double st;       ///< sine of the angle to t, from x and y, never from 1 - z^2
  double l, m, t;  ///< deviations towards l and m, angle to t
  double ratio;    ///< r = t / st
  double rise;     ///< dr = rise (x dx + y dy) - dz, with rise = (z - r) / st^2
};

/// How fast the two deviations change.
struct DeviationRates {
  double l, m;
};

namespace lanes {

/// A node frame.
struct NodeAxes {
  V3 l, m, t;
};

/// The deviation of an edge from the tangent is one turn by t across it, of which l and m are the
/// components: t (x, y) / sin t. So it is a true angle up to half a turn, where asin of the components
/// would turn back at a quarter. Near the tangent the ratio t / sin t comes from a series, where the
/// quotient is 0 / 0.
TENDRIL_INLINE EdgeAngles edge_angles(const V3& e, const NodeAxes& frame) {
  EdgeAngles a{};
  a.x = dot(e, frame.l);
  a.y = dot(e, frame.m);
  a.z = dot(e, frame.t);
  const double w = a.x * a.x + a.y * a.y;
  a.st = std::sqrt(w);
  if (w <= kNearSquare && a.z > 0.0) {
    const Arc arc = near_arc(w);
    a.ratio = arc.ratio;
    a.rise = arc.rise - (arc.ratio + arc.rise * w);
    a.t = arc.ratio * a.st;
  } else {
    a.t = std::atan2(a.st, a.z);
    a.ratio = a.t / a.st;
    a.rise = (a.z - a.ratio) / w;
  }
  a.l = a.ratio * a.x;
  a.m = a.ratio * a.y;
  return a;
}

/// \param t_rate, spin  of the frame, which turns by t' and about t
TENDRIL_INLINE DeviationRates deviation_rates(const NodeAxes& f, const EdgeAngles& at, const V3& e_rate,
                                              const V3& t_rate, double spin) {
  // The frame's m' = -(m.t') t - w l, l' = -(l.t') t + w m.
  const double x = dot(e_rate, f.l) - dot(f.l, t_rate) * at.z + spin * at.y;
  const double y = dot(e_rate, f.m) - dot(f.m, t_rate) * at.z - spin * at.x;
  const double z = dot(e_rate, f.t) + dot(t_rate, at.x * f.l + at.y * f.m + at.z * f.t);
  const double rising = at.rise * (at.x * x + at.y * y) - z;
  return {at.ratio * x + rising * at.x, at.ratio * y + rising * at.y};
}

}  // namespace lanes
}  // namespace tendril
