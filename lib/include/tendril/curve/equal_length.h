#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/arc_length.h>
#include <tendril/curve/axial.h>

namespace tendril {

/// Length-preserving axial deformation (Peng, Jin and Feng 1997): the record with its parameter moved to
/// where the posed primary curve has the arc length that the rest curve had at the record's t. Where the
/// posed curve is too short, the remainder goes straight on along its end tangent (into w).
TENDRIL_CORE_API AxialPoint at_equal_length(const ArcLength& rest, const ArcLength& posed,
                                            const AxialPoint& record);

}  // namespace tendril
