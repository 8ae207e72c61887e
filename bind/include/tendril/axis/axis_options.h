#pragma once

#include <cstddef>
#include <optional>

namespace tendril::axis {

/// What find_axis is asked for. Lengths are in the mesh's own unit.
struct AxisOptions {
  /// Work on a copy whose holes are closed, each by a fan about its middle, and whose non-manifold points are
  /// split. Otherwise a mesh with holes is refused.
  bool close = false;
  /// Work on the part with the largest area alone; parts that only points join are told apart. Otherwise a
  /// mesh of several parts is refused.
  bool largest_part = false;

  /// An end branch of the skeleton is pruned when its tip is less far from where it branches off than this
  /// many times the distance to the surface there, and less than 3/4 of it or no limb beside it is alike: as
  /// long within 15 %, and kept. At least 0; 0 keeps all.
  double prune = 2.0;
  /// Distance between the nodes of the curves, approximately; by default a fortieth of the longest curve.
  /// At least a ten thousandth of that.
  std::optional<double> spacing;
  /// Largest deviation of a fitted curve from the skeleton drawn to the middle, relative to the distance to
  /// the surface there.
  /// Above 0, at most 1.
  double tolerance = 0.15;

  /// Coarser meshes are split at the middles of their edges first: the contraction of a coarse one loses
  /// limbs.
  std::size_t least_points = 4000;
  /// Seconds for the contraction of the surface, which need not converge. Above 0.
  double time_limit = 60.0;
};

}  // namespace tendril::axis
