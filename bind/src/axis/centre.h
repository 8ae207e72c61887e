#pragma once

#include "paths.h"
#include "surface.h"

namespace tendril::axis {

/// The line's points, those that lie outside the surface or far nearer to one side of it than to the other
/// put half way between the two, across the line, and the moves smoothed along it; then all points in the
/// middle of the limb's section where that is round. A contraction draws its skeleton to the inner side of
/// bends, out of thin limbs, and along some limbs to one side all the way.
///
/// Half way is meant of a limb about as thick as the line's clearance nearby, so that where a leg's axis runs
/// beneath a flank it is not drawn to the middle of the body.
/// \param line  evenly spaced, of two points or more, in a mesh of about unit size
Line centred(const Line& line, const Surface& surface, const Stays& stays);

/// Carries a line that ends early in a limb that goes straight on, and is about as thick there, on to where
/// what is ahead is as far as what is beside. \return by how much
double extend_end(Line& line, const Surface& surface);

/// Half the width of the limb at each point: its clearance, or half the largest nearby where that is more, as
/// a point off the middle has hardly any. Above 0.
std::vector<double> half_widths(const Line& line, const Surface& surface);

}  // namespace tendril::axis
