#pragma once

#include <tendril/bind/binding.h>
#include <tendril/dynamics/simulation.h>

#include "rivals/flat_run.h"

namespace tendril::gallery {

/// The frames of a motion, and what they cost.
struct Moved {
  std::vector<std::vector<Vec3>> frames;
  long accepted = 0, evaluations = 0;
};

/// Times of `count` frames, the last one at `duration`.
std::vector<double> frame_times(double duration, int count);

/// Moves a net; frames are its masses. Throws std::runtime_error where it does not finish.
Moved move_net(const SpringNet& net, const NetOptions& options, std::span<const double> times);

/// Moves a system; frames are its masses, or the points bound to its curve-pairs. Throws as above.
Moved move_system(const System& system, const SimulationOptions& options, std::span<const double> times,
                  const bind::Binding* binding = nullptr);

/// Root mean square of the distances between the points of two motions, over all frames.
double distance(const Moved& a, const Moved& b);

}  // namespace tendril::gallery
