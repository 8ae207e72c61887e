#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/curve_pair.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What find_axis returns.
namespace tendril::axis {

/// Where a curve starts: at a node of an earlier one.
struct AxisJoint {
  std::size_t parent;  ///< index of that curve
  std::size_t node;    ///< of its nodes
};

/// A chain of nodes, as a rod's masses or as points that a cubic passes through: the curve-pair of `points`
/// and `orientation` by centripetal interpolation (curve/fit.h).
struct AxisCurve {
  std::vector<Vec3> points;  ///< its nodes, at least 2
  /// Beside them, a mean edge away, in the direction of rotation-minimising frames.
  std::vector<Vec3> orientation;
  std::vector<double> radius;      ///< of each node: distance to the surface
  std::optional<AxisJoint> joint;  ///< none for the first; then points[0] is the parent's node
  double length = 0.0;             ///< of the chain
  double strays = 0.0;             ///< largest distance of skeleton and curve, over that to the surface there
  std::size_t outside = 0;  ///< nodes, and points of the curve half way between them, outside the surface
  bool folds = false;       ///< its frames do not carry on (curve/frame_jump.h): nothing can be bound to it
};

/// A piece of the skeleton cut off as spurious.
struct Twig {
  Vec3 root;      ///< where it branched off
  Vec3 tip;       ///< its other end
  double length;  ///< along it
  double reach;   ///< the figure that AxisOptions::prune is compared with
};

/// What find_axis did to the mesh and to its skeleton.
struct AxisReport {
  std::size_t closed_holes = 0;    ///< of the mesh, in the copy
  std::size_t split_points = 0;    ///< non-manifold ones
  std::size_t left_out_parts = 0;  ///< connected components other than the largest
  bool turned = false;             ///< the mesh is inside out; the copy was turned
  std::size_t splits = 0;          ///< times that each triangle was split in four
  int contractions = 0;            ///< steps of the mean curvature flow
  std::size_t ends = 0;            ///< of the skeleton, before pruning
  std::size_t junctions = 0;       ///< of the skeleton, before pruning
  std::size_t loops = 0;           ///< independent ones, before they are cut open: the genus of the surface
  std::vector<Twig> twigs;         ///< in the order they were cut off
  std::vector<Vec3> cuts;  ///< where loops were cut open: two curves, or one curve's two ends, meet there
  /// Share of the skin's area no farther from each point's nearest curve than three times the distance there
  /// to the surface, the nearest by that ratio.
  double coverage = 0.0;
  Vec3 farthest = Vec3::Zero();  ///< the point of the skin whose ratio is the largest
  double farthest_radii = 0.0;   ///< that ratio
};

/// Outcome of find_axis.
enum class AxisStatus {
  found,       ///< at least one curve, and the skin has curves near
  uncovered,   ///< curves, but AxisReport::coverage is below 0.9
  folded,      ///< curves, but AxisCurve::folds is set of some
  time_limit,  ///< no curves: see AxisOptions::time_limit
  diverged     ///< no curves: the contraction left the finite numbers
};
/// The enumerator's name.
TENDRIL_AXIS_API const char* to_string(AxisStatus status);

/// A tree of curves. Parents come before their children; the first curve is the longest path through the
/// skeleton.
struct AxisTree {
  AxisStatus status = AxisStatus::found;  ///< the curves are empty unless found, uncovered or folded
  std::string reason;                     ///< one sentence, unless found
  std::vector<AxisCurve> curves;          ///< parents first
  AxisReport report;                      ///< filled as far as the work went
};

/// The curve-pair through a chain: degree 3, less for fewer than four nodes.
TENDRIL_AXIS_API CurvePair pair_of(const AxisCurve& curve);

}  // namespace tendril::axis
