#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/arc_length.h>
#include <tendril/curve/axial.h>

namespace tendril {

/// Length-preserving axial deformation [Peng et al. 1997]: the record with its parameter moved to where the
/// posed primary curve has the arc length that the rest curve had at the record's t. Where the posed curve is
/// too short, the remainder extends it along its end tangent (added to w). Cost: that of ArcLength::length_to
/// and parameter_at.
/// \param rest    arc length of the rest primary curve
/// \param posed   arc length of the posed one
/// \param record  made on the rest curve-pair
TENDRIL_CORE_API AxialPoint at_equal_length(const ArcLength& rest, const ArcLength& posed,
                                            const AxialPoint& record);

}  // namespace tendril
