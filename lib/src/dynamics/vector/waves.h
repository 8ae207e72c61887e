#pragma once

#include <span>
#include <vector>

namespace tendril {

/// a sin(phase - frequency d) of a delay d, with s = a sin(phase) and c = a cos(phase): whatever the phase, so
/// that it may be as large as a run is long.
struct CarriedWave {
  double s, c, frequency;
};

/// Up to which |frequency d| sums are exact to some ulps of the amplitudes.
constexpr double kFarthestPhase = 1e6;

/// Adds all waves at each delay. Where the delays are some dozens and lie so near each other that no wave turns by
/// more than a few rad between them, the sum is one series about their middle, to 1e-14 of the amplitudes: some
/// 1 ns a delay, and else 1 ns a delay and wave.
void add_waves(std::span<const CarriedWave> waves, std::span<const double> delay, std::span<double> sum);

}  // namespace tendril
