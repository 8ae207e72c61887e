#pragma once

#include <span>

namespace tendril {

/// Up to which |frequency at| add_wave is exact to some ulps of the amplitude.
constexpr double kFarthestPhase = 1e6;

/// Adds a sin(phase - frequency at_i) to each sum_i, with s = a sin(phase) and c = a cos(phase): whatever the
/// phase, so that it may be as large as a run is long. Some 3 ns each.
void add_wave(double s, double c, double frequency, std::span<const double> at, std::span<double> sum);

}  // namespace tendril
