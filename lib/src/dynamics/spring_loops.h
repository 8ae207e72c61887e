#pragma once

#include <algorithm>

#include "elastic.h"

/// What the loops over springs share.
namespace tendril {

/// A loop over the nodes or edges [first, end). Loops for small angles need neither divisions nor roots; what
/// they say is whether all were small.
using Loop = bool (*)(const System::Model&, const State&, std::size_t first, std::size_t end,
                      System::Workspace&);
struct Loops {
  Loop near, far;
};

/// Stretches of this length are done again with the far loop where the near one does not hold.
constexpr std::size_t kStretch = 128;

inline bool run(const Loops& loops, const System::Model& model, const State& reference,
                const System::Model::Segment& segment, System::Workspace& work) {
  bool good = true;
  for (std::size_t first = segment.first; first < segment.end; first += kStretch) {
    const std::size_t end = std::min(first + kStretch, segment.end);
    if (!loops.near(model, reference, first, end, work))
      good = loops.far(model, reference, first, end, work) && good;
  }
  return good;
}

/// The bending of rods without twist state in a segment: the springs between two edges, with the energy of
/// each node in work.energy when asked for. Fails where two edges fold back.
Evaluation hinge(const System::Model& model, const State& reference, const System::Model::Segment& segment,
                 bool energy, System::Workspace& work);

/// The springs between the edges at a node and its held frame, of a rod without twist: 1/2 K angle^2 each.
/// What they give the edges goes to g_before and g_after. Returns the energy.
double bend_at_held_hinge(const System::Model& model, std::size_t node, System::Workspace& work);

/// The same for a rod with twist; adds what the frame feels. With `viscous` each but the third resists.
double bend_at_held_frame(const System::Model& model, std::size_t node, bool viscous, System::Workspace& work,
                          double& heat);

}  // namespace tendril
