#pragma once

#include <tendril/contact/collider.h>
#include <tendril/curve/curve_pair.h>

#include <array>
#include <cstdint>

namespace tendril::contact {

/// A span of a curve-pair that vertices are bound to, or a part of it.
struct UsedSpan {
  /// \param part, parts  which of so many parts of the span, of the same length
  UsedSpan(std::uint32_t pair, const KnotVector& knots, int span, int part = 0, int parts = 1);

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
/// The same mass by mass and edge by edge, since what a span is depends on those nearby.
struct LocalGain {
  std::size_t first = 0, count = 0;       ///< of masses, and of the edges that begin there
  std::vector<double> at, rate;           ///< per Bezier point, those of `count` masses and edges
  double at_rest = 0.0, rate_rest = 0.0;  ///< of all others together
  double all = 0.0;                       ///< of all masses
};
LocalGain local_gain_of(const UsedSpan& span, const std::vector<std::vector<double>>& interpolation);
/// How far each mass of a rod moved, each edge between them and each orientation mass against it changed.
struct MassMotions {
  std::vector<double> mass, edge, arm;  ///< edge i from mass i on; the last is 0
};

/// How far masses of a rod moved at most, edges between them and orientation masses against them changed.
struct RodMotion {
  double mass = 0.0, edge = 0.0, arm = 0.0;
  double size = 0.0;  ///< how far from the origin masses are
};
/// As motion() between two poses as the world sees them, without a look at the curves now; of several spans
/// by the largest gains and reach and the worst shape.
/// \param reach  of the span
double motion(const SpanGain& gain, double reach, const SpanShape& shape_before, const RodMotion& rod);
/// The same, sharper where masses moved by different ways.
/// \param most  of `masses`
double motion(const LocalGain& gain, const UsedSpan& span, const SpanShape& shape_before,
              const RodMotion& most, const MassMotions& masses);

/// Bezier points of a span, of its derivative by a parameter of its own, and of n.
struct SpanControls {
  std::array<Vec3, kMaxDegree + 1> at, rate, offset;
};
/// A span whose control points go straight from where they are to where they will be, by a share of the way
/// from 0 to 1, and with it what is bound to it. That is taken to go straight, too, from where it is to where
/// it will be; frames turn on the way, and it strays a little.
struct SpanWay {
  SpanControls at, change;
  SpanShape shape;  ///< all the way
  double bow;  ///< how far what is bound to it strays at most, halfway; infinite where frames may turn round
};
/// How far after a share of the way.
inline double strays(double bow, double share) {
  return share > 0.0 && share < 1.0 ? 4.0 * share * (1.0 - share) * bow : 0.0;
}
/// Off its chord a point is by an eighth of what its second derivatives by the share are at most. Of
/// Z = D / |D|, D = c', d all that D changes, s the least |D|: Z' = d across Z / |D|, at most a = |d| / s;
///   Z'' = -|Z'|^2 Z - 2 (Z.d / |D|) Z'.
/// Of Y = m / |m|, m = n - (n.Z) Z, e all that n changes:
///   m'  = e across Z - (n.Z') Z - (n.Z) Z',
///   m'' = -(2 e.Z' + n.Z'') Z - 2 (e.Z + n.Z') Z' - (n.Z) Z'',
///   Y'' = (m'' across Y) / |m| - |Y'|^2 Y - 2 (|m|' / |m|) Y';
/// of the axis across both at most |Y''| + 2 |Y'| |Z'| + |Z''|. Z.d, n.Z and e across Z are bounded by those
/// along the mean of c' and how far Z is from it.
SpanWay way_of(const UsedSpan& span, const CurvePair& from, const CurvePair& to);
/// How far what is bound to the span is at most from where it is taken to be after a share of its way.
double motion(const UsedSpan& span, const SpanWay& way, double share, const CurvePair& now);

}  // namespace tendril::contact
