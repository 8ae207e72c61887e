#pragma once

#include "curve/distance/projector_data.h"

namespace tendril {

/// What is to be said of the nearest point found.
Projection describe(const CurveProjector::Data& data, const Vec3& p,
                    const CurveProjector::Data::Found& found);

/// The same of many, to the last bit, in vector lanes, for a curve of degree P.
template <int P>
std::vector<Projection> describe_all(const CurveProjector::Data& data, Points points,
                                     std::span<const CurveProjector::Data::Found> found);

}  // namespace tendril
