#pragma once

#include <algorithm>

#include "workspace.h"

/// What the loops over springs share.
namespace tendril {

/// A loop over the nodes or edges [first, end). Loops for small angles need neither divisions nor roots; what
/// they say is whether all were small.
using Loop = bool (*)(const Model&, const State&, std::size_t first, std::size_t end, const Kinematics&,
                      Gradient&);
struct Loops {
  Loop near, far;
};

/// Stretches of this length are done again with the far loop where the near one does not hold.
constexpr std::size_t kStretch = 128;

inline bool run(const Loops& loops, const Model& model, const State& reference, const Model::Segment& segment,
                const Kinematics& kin, Gradient& grad) {
  bool good = true;
  for (std::size_t first = segment.first; first < segment.end; first += kStretch) {
    const std::size_t end = std::min(first + kStretch, segment.end);
    if (!loops.near(model, reference, first, end, kin, grad))
      good = loops.far(model, reference, first, end, kin, grad) && good;
  }
  return good;
}

}  // namespace tendril
