#pragma once

#include <tendril/base/export.h>

#include <cstddef>
#include <vector>

namespace tendril::scene {

/// When a run hands out its snapshots: times that ascend from 0, none beyond the duration, whatever the
/// rounding of their quotients.
///
/// Spread evenly, and the last is exactly the duration.
/// \param duration  positive and finite
/// \param frames    at least 2
TENDRIL_SCENE_API std::vector<double> output_times(double duration, std::size_t frames);

/// Multiples of a step. The last is exactly the duration where that is a multiple to one part in 10^12.
/// \param duration  positive and finite
/// \param step      positive; the quotient of both is the number of times after 0
TENDRIL_SCENE_API std::vector<double> output_times_every(double duration, double step);

}  // namespace tendril::scene
