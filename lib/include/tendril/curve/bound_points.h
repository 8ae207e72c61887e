#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/axial.h>
#include <tendril/curve/control_forces.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tendril {

/// What a point takes from one curve-pair: of a skinned vertex, an influence.
struct BoundShare {
  std::uint32_t pair;  ///< index of the curve-pair
  double weight;       ///< at least 0
  AxialPoint record;   ///< the point's coordinates there
};

/// Points that follow curve-pairs, in groups that are placed each alone: what a hierarchy needs of a bound
/// mesh that it deforms where it is touched.
class TENDRIL_CORE_API PointGroups {
 public:
  virtual ~PointGroups() = default;

  /// The curve-pairs that place() uses from now on; O(spans). They are not needed after the call.
  /// \param posed  on the knots of the rest, as many as there were; else InvalidInput
  virtual void pose(std::span<const CurvePair> posed) = 0;

  /// The points of a group in the order they were given, bit for bit where an update of all puts them.
  /// Throws InvalidInput where there was no pose().
  /// \param group  its index
  /// \param out    as many as the group has
  virtual void place(std::size_t group, MutablePoints out) const = 0;
};

/// Points bound to curve-pairs. A point is p_0 + sum_k w_k (p_k - p_0) over its shares k = 1, 2, ..., the w_k
/// at least 0 and their sum at most 1 up to rounding; p_k = c(t) + u l_x + v l_y + w l_z.
///
/// What an implementation promises, and a bound on positions rests on. For a share in a span of the knots
/// (that of KnotVector::span) whose control points U_i of c and V_i of c_D are at most M from the origin, the
/// computed p differs from that of exact arithmetic by at most
///   2^-36 M + 2^-36 M (|u| + |v| + |w|) ((1 + |n| / n') / |dc/ds| + 1 / n'),
/// with ds the parameter in units of the span, n = c_D - c, n' its part across the tangent; and depends on
/// these control points alone wherever |dc/ds| and n' are at least 1/64 of the largest |U_i - U_j| and
/// |V_i - U_i|. Anywhere, |p - c| is at most |u| + |v| + |w| up to 2^-36 of it: whatever became of the frame,
/// its axes have length 1. A record with w below 1e-15 of the size may be taken to have w = 0.
class TENDRIL_CORE_API BoundPoints {
 public:
  virtual ~BoundPoints() = default;

  virtual std::size_t size() const = 0;  ///< number of points
  /// The shares of a point, p_0 first; `out` is overwritten.
  virtual void shares(std::size_t point, std::vector<BoundShare>& out) const = 0;

  /// Points in groups: group g are the points[begin[g], begin[g + 1]); a point may be in several.
  virtual std::unique_ptr<PointGroups> group(std::span<const std::uint32_t> begin,
                                             std::span<const std::uint32_t> points) const = 0;
};

/// Bound points that can be met: some of them at a time, their velocities, and the transpose. The `points`
/// are indices, `posed` on the knots of the rest; else InvalidInput. Safe to call from several threads.
class TENDRIL_CORE_API LoadedPoints : public BoundPoints {
 public:
  /// Where points are, in the order given.
  virtual void place(std::span<const CurvePair> posed, std::span<const std::uint32_t> points,
                     MutablePoints out) const = 0;
  /// How fast they move where the control points of `posed` move as fast as those of `rates` say. A point
  /// without a frame moves as the curve's point.
  virtual void velocities(std::span<const CurvePair> posed, std::span<const CurvePair> rates,
                          std::span<const std::uint32_t> points, MutablePoints out) const = 0;
  /// Forces on points as forces on the control points that do the same work.
  virtual std::vector<ControlForces> pull_back(std::span<const CurvePair> posed,
                                               std::span<const std::uint32_t> points,
                                               Points forces) const = 0;
};

}  // namespace tendril
