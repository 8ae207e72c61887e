#pragma once

#include "branch_graph.h"
#include "surface.h"

namespace tendril::axis {

/// The line's points, those that lie outside the surface or far nearer to one side of it than to the other
/// put half way between the two, across the line, and the moves smoothed along it. A contraction draws its
/// skeleton to the inner side of bends, and out of thin limbs. The first point stays.
///
/// Half way is meant of a limb about as thick as the line's clearance nearby, so that where a leg's axis runs
/// beneath a flank it is not drawn to the middle of the body.
/// \param line  evenly spaced, in a mesh of about unit size
Line centred(const Line& line, const Surface& surface);

/// Half the width of the limb at each point: its clearance, or half the largest nearby where that is more, as
/// a point off the middle has hardly any. Above 0.
std::vector<double> half_widths(const Line& line, const Surface& surface);

}  // namespace tendril::axis
