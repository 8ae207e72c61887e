#pragma once

#include "study/reference.h"

namespace tendril::runner {

/// A second opinion on scenes too stiff for explicit methods: backward Euler at steps halved again and again,
/// its error in powers of the step taken away one by one (Richardson, Romberg). Positions and frames are
/// extrapolated alike, at each output. Wants outputs that are evenly spaced; dense matrices make it one for a
/// few hundred unknowns. \param seconds  of CPU time it may take. Nothing when fewer than two step sizes
/// finish
std::optional<Tightest> extrapolated_run(const Study& study, double seconds);

}  // namespace tendril::runner
