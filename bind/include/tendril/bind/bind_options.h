#pragma once

#include <tendril/curve/axial.h>

#include <cstdint>
#include <vector>

/// What a Binding is asked for, and what it says about itself.
namespace tendril::bind {

/// What a point is bound to. Nearest is meant by distance; of several curve-pairs, that to one which the
/// faces at a point look towards, as a body's do towards the arm beside it, counts for up to ten times as
/// much.
enum class BindMode {
  /// Its nearest projection: where that jumps from one place of the axis to another, the mesh tears.
  nearest,
  /// The same, but all places of the axis around it where its nearest projection is about to jump.
  continuous
};

struct BindOptions {
  BindMode mode = BindMode::nearest;
  /// BindMode::continuous: width of the zone beside a jump of the nearest projection, in units of the
  /// distance to the axis there, or of what the distance about is less half the way, where the mesh runs into
  /// its own axis. Above 0, at most 1. Wider is gentler, and blends more of the mesh.
  double band = 0.25;
  /// 1 to 256; the same bits for any number.
  int threads = 1;
};

/// A place of an axis that a point is bound to, and its part in the point.
struct Share {
  std::uint32_t pair;
  double weight;
  AxialPoint record;
};

/// What binding found out about its points. Lists are ascending.
struct BindReport {
  /// Largest distance between a point and its update on the unmoved curve-pair [length].
  double rest_error = 0.0;
  /// Largest proven gap of a projection: how much longer than the true minimum [length].
  double largest_gap = 0.0;
  /// Number of points nearest to one of the two ends.
  std::size_t beyond_ends = 0;
  /// Points whose frame has a status other than ok.
  std::vector<std::uint32_t> degenerate;
  /// Points with lambda <= 0: the axis bends round them, the map of their nearest projection folds there.
  std::vector<std::uint32_t> past_focus;
  /// Near where the nearest projection jumps or splits: bound to several places. None in BindMode::nearest.
  std::vector<std::uint32_t> ambiguous;
  /// Points one of whose projections was refused: no way over the mesh leads to where it is the nearest.
  std::vector<std::uint32_t> gated;
  /// Number of points with projections that cannot be told apart.
  std::size_t clusters = 0;
  /// Number of places in use, over all points.
  std::size_t places = 0;
};

}  // namespace tendril::bind
