#pragma once

#include <tendril/contact/collider.h>
#include <tendril/curve/curve_pair.h>

#include <array>
#include <cstdint>

namespace tendril::contact {

/// A span of a curve-pair that vertices are bound to.
struct UsedSpan {
  UsedSpan(std::uint32_t pair, const KnotVector& knots, int span);

  std::uint32_t pair, first, count;  ///< its control points [first, first + count)
  /// Its Bezier points, row by row, from these control points: the hull of what it alone is, while control
  /// points are also about the spans beside it.
  std::array<std::array<double, kMaxDegree + 1>, kMaxDegree + 1> bezier;
  double reach = 0.0;  ///< largest |u| + |v| + |w| of what is bound to it
};

/// What bounds a frame's turns from a pose: at least |c'| and |n'|, n' the part of n = c_D - c across c', and
/// at most |n|, all over the span. Speeds of 0 or less say nothing.
struct SpanShape {
  double least_speed, least_across, most_offset;
};
SpanShape shape_of(const UsedSpan& span, const CurvePair& pair);

/// Curve-pairs in the frame of a solid.
struct PosedFrom {
  const CurvePair& pair;
  const Placement& solid;
};

/// How far a point that is bound to the span moved at most between two poses, each seen from its solid;
/// infinite where the shape before says nothing, or what changed is as large as it. Unit vectors along x
/// and y are no farther apart than |x - y| / min(|x|, |y|): with dU, dD, dN the largest changes of Bezier
/// points, of those of c' and of n, Z = c' / |c'| moved by at most a = dD / (|c'| - dD); n' by at most d =
/// dN + a |n|, since projections along two directions differ by the sine between them; the unit vector
/// along it by at most b = d / (|n'| - d), the axis across both by a + b; so a point by at most dU + (|u| +
/// |v| + |w|) (a + b).
double motion(const UsedSpan& span, const SpanShape& shape_before, const PosedFrom& before,
              const PosedFrom& now);

/// By how much Bezier points of a span move at most, in units of how far the farthest mass of its rod does;
/// and those of its derivative, in units of how much the edge between masses that changes most does.
struct SpanGain {
  double at, rate;
};
/// \param interpolation  of the rod, see RodCurves
SpanGain gain_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation);
/// How far masses of a rod moved at most, edges between them and orientation masses against them changed.
struct RodMotion {
  double mass = 0.0, edge = 0.0, arm = 0.0;
  double size = 0.0;  ///< how far from the origin masses are
};
/// As motion() between two poses as the world sees them, without a look at the curves now.
double motion(const SpanGain& gain, const UsedSpan& span, const SpanShape& shape_before,
              const RodMotion& rod);

/// A frame that goes with a span, about the mean of its Bezier points: the axes of the means of c' and n.
Placement going_with(const UsedSpan& span, const CurvePair& pair);
/// The same as motion() between two poses as the world sees them, sharper where the span moves as one: how
/// far the frame that goes with it takes what it holds, and how far that moves as seen from there.
/// \param from, to  going_with() before and now
double motion(const UsedSpan& span, const SpanShape& shape_before, const CurvePair& before,
              const Placement& from, const CurvePair& now, const Placement& to);

}  // namespace tendril::contact
