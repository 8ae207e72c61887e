#pragma once

#include "branches.h"

/// Where the nearest curve-pair is the wrong one.
namespace tendril::bind {

/// Points nearest to an axis that is not theirs: skin of a body that an arm hangs beside, nearer to the arm's
/// axis than to the body's own.
struct Island {
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<std::uint32_t> pairs;   ///< of the points around it, ascending, at least one
};

/// Areas of points nearest to one curve-pair, joined by edges, that are islands: a larger area has the same
/// curve-pair, goes along the whole piece of it that the island is nearest to, and is turned to it the other
/// way: its faces look away from the axis and the island's towards it, or the reverse.
///
/// \param nearest  of each point
std::vector<Island> find_islands(const PolygonMesh& mesh, const Neighbours& neighbours,
                                 std::span<const Candidate> nearest);

}  // namespace tendril::bind
