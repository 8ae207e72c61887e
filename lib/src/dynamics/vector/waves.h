#pragma once

#include <span>
#include <vector>

namespace tendril {

/// a sin(phase - frequency d) of a delay d, with s = a sin(phase) and c = a cos(phase): whatever the phase,
/// so that it may be as large as a run is long.
struct CarriedWave {
  double s, c, frequency;
};

/// Adds all waves at each delay, to 1e-14 of the amplitudes (by |frequency d| rounded). Where the delays are
/// some dozens and so near each other that no wave turns by more than a few rad between them, the sum is one
/// series about their middle: some 1 ns a delay. Else it takes 1 ns a delay and wave, or 20 where
/// |frequency d| is above 1e6.
void add_waves(std::span<const CarriedWave> waves, std::span<const double> delay, std::span<double> sum);

}  // namespace tendril
