#pragma once

#include <tendril/curve/axial.h>

#include <cstdint>
#include <vector>

/// What a Binding is asked for, and what it says about itself.
namespace tendril::bind {

/// What a point is bound to. The nearest projection is that of least distance. With several curve-pairs, the
/// distance to a curve is multiplied by up to ten where the way there through the body is longer than the
/// straight one: a body's skin beside an arm is nearer to the arm's axis, but the way leads by the shoulder.
enum class BindMode {
  /// The nearest projection alone. Across the cut locus of the axes, where it jumps from one part of the axes
  /// to another, the mesh tears.
  nearest,
  /// Beside the cut locus, a weighted mean over the part of the axes around the point; elsewhere as
  /// `nearest`.
  continuous
};

/// How points are bound.
struct BindOptions {
  BindMode mode = BindMode::continuous;  ///< what a point is bound to
  /// BindMode::continuous: width of the blended zone on either side of the cut locus, relative to a local
  /// scale r: the smallest function on the mesh that is at least the distance d to the axis and falls along
  /// the mesh by at most half the length of the path. r is d but near where the mesh meets its own axis,
  /// where d vanishes and r does not. Above 0, at most 1. A wider zone stretches the mesh less and blends
  /// more of it.
  double band = 0.5;
  /// 1 to 256; the same bits for any number.
  int threads = 1;
};

/// One point of the axes that a point of the mesh is bound to, with its weight.
struct Share {
  std::uint32_t pair;  ///< index of the curve-pair
  double weight;       ///< above 0; those of one point sum to 1
  AxialPoint record;   ///< the point's coordinates there
};

/// A connected part of the mesh that sits in or on a limb, as an iris or a button does, and follows it whole,
/// from one place of its axis.
struct LoosePart {
  std::uint32_t first;  ///< its first point
  std::size_t points;   ///< how many it has
  std::uint32_t pair;   ///< curve-pair that it follows
  double t;             ///< parameter of the place there
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
  /// Points with Projection::lambda <= 0, at or beyond the centre of curvature of their nearest point: the
  /// nearest projection is no smooth function of the point there.
  std::vector<std::uint32_t> past_focus;
  /// Points beside the cut locus, with more than one Share. None in BindMode::nearest.
  std::vector<std::uint32_t> ambiguous;
  /// Points one of whose projections was left out: no path on the mesh, along which that projection varies
  /// continuously, leads to a point whose nearest it is.
  std::vector<std::uint32_t> gated;
  /// Parts that follow one place of the axes, by their first points. None in BindMode::nearest to a single
  /// curve-pair.
  std::vector<LoosePart> loose;
  /// Number of points with a LocalMinimum::cluster among their projections.
  std::size_t clusters = 0;
  /// Number of shares, over all points.
  std::size_t shares = 0;
};

}  // namespace tendril::bind
