#pragma once

#include "branch_graph.h"

#include <tendril/curve/bspline.h>

namespace tendril::axis {

/// A line's points at even lengths along it.
Line evenly(const Line& line, std::size_t count);

/// The clamped cubic on uniform knots whose ends are those of the line and that is least away, in the sum of
/// squares, from its points, which are at the parameters k / (count - 1).
/// \param control_points  at least 4, at most half the points
BSpline least_squares(const Line& points, int control_points);

/// The same with as few control points as keep each point p_k of the line within `tolerance` of c(t_k), in
/// units of `width` at p_k; with half as many as there are points, at the most.
BSpline fit(const Line& points, const std::vector<double>& width, double tolerance);

}  // namespace tendril::axis
