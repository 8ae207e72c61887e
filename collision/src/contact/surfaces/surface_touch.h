#pragma once

#include "surface_model.h"

namespace tendril::contact {

/// A point in the range of a solid.
struct SurfaceMeeting {
  NearPoint at;
  std::uint64_t key;  ///< of its KeptTouch
  Response response;
};

/// The response to a point within the range.
SurfaceMeeting meeting(const SurfaceModel& model, PosedSurface& surface, const SurfaceLedger* kept,
                       const NearPoint& at);

/// False where a point whose gap is open cannot have come straight from where it was without closing it.
bool reachable(const SurfaceModel& model, PosedSurface& surface, const SurfaceLedger* kept,
               const NearPoint& at);

/// Calls visit(SurfaceMeeting) for every point within the range, in order. Ends at the first point that a
/// barrier cannot let be where it is, and returns it; empty where there is none.
template <class Visit>
std::optional<NearPoint> each_meeting(const SurfaceModel& model, PosedSurface& surface,
                                      const SurfaceLedger* kept, Visit&& visit) {
  std::optional<NearPoint> closed;
  surface.each_near([&](const NearPoint& at) {
    if (model.barrier() && (!(at.near.gap > 0.0) || !reachable(model, surface, kept, at))) {
      closed = at;
      return false;
    }
    if (at.near.gap < model.law.range) visit(meeting(model, surface, kept, at));
    return true;
  });
  return closed;
}

}  // namespace tendril::contact
