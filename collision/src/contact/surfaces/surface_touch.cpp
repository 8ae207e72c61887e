#include "surface_touch.h"

namespace tendril::contact {
namespace {

Vec3 at_point(const NearPoint& at, const std::vector<Vec3>& of) {
  const auto& [i, j, k] = at.triangle->corner;
  return mix(at.at->share, of[i], of[j], of[k]);
}

/// Where a point was when the ledger was kept, in the frame of the solid.
Vec3 local_before(PosedSurface& surface, const SurfaceLedger& kept, const NearPoint& at) {
  return kept.solids[at.near.collider].to_local(at_point(at, surface.vertices_before(*at.patch)));
}

}  // namespace

bool reachable(const SurfaceModel& model, PosedSurface& surface, const SurfaceLedger* kept,
               const NearPoint& at) {
  if (!kept || at.moved < at.near.gap) return true;
  const std::size_t c = at.near.collider;
  return clear_way(*model.colliders[c].shape, at.near, local_before(surface, *kept, at),
                   at.near.radius + model.margin(*at.at, c), model.law.range);
}

SurfaceMeeting meeting(const SurfaceModel& model, PosedSurface& surface, const SurfaceLedger* kept,
                       const NearPoint& at) {
  const std::size_t c = at.near.collider;
  const std::uint64_t key = at.near.point * model.colliders.size() + c;
  std::optional<Vec3> from;
  if (kept && model.law.friction > 0.0) {
    // What comes into the range within a step is held where it was when the step began: it slides from there.
    const KeptTouch* was = find_key(kept->kept, key);
    from = was ? was->stick_at : local_before(surface, *kept, at);
  }
  const bool damped = model.law.damping > 0.0 || model.law.stick_damping > 0.0;
  const Vec3 velocity = damped ? at_point(at, surface.velocities(*at.patch)) : Vec3(Vec3::Zero());
  return {at, key, respond(*model.colliders[c].shape, model.law, at.at->weight, at.near, from, velocity)};
}

}  // namespace tendril::contact
