#include <tendril/base/error.h>

#include <algorithm>
#include <string>
#include <utility>

#include "surface_touch.h"

namespace tendril::contact {
namespace {

/// The ledger at a new accepted state.
class SurfaceKeeper {
 public:
  SurfaceKeeper(const SurfaceModel& model, const StateView& state, const SurfaceLedger* before)
      : model_(model), state_(state), before_(before), ledger_(std::make_shared<SurfaceLedger>()) {
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->placed = before->placed;
  }

  std::shared_ptr<const SurfaceLedger> keep() {
    PosedSurface surface(model_, state_, before_, PosedSurface::Colliders::all);
    if (!surface.sound()) throw InvalidInput("contact.surface", "too far from the origin", "less than 1e150");
    const auto closed = each_meeting(model_, surface, before_, [&](const SurfaceMeeting& at) { add(at); });
    if (closed && !before_) refuse(*closed);
    ledger_->p = model_.positions(state_);
    ledger_->pairs = surface.pairs();
    ledger_->solids = surface.placed();
    for (const UsedSpan& span : model_.laid.spans)
      ledger_->shapes.push_back(shape_of(span, ledger_->pairs[span.pair]));
    keep_slacks(surface);
    ledger_->placed += surface.deformed();
    ledger_->vertices = surface.take_vertices();
    // Points are met patch by patch and, on a patch, solid by solid, which mixes the keys.
    sort_by_key(ledger_->kept);
    return std::move(ledger_);
  }

 private:
  /// What was left less what has moved since, measured anew where that is little.
  void keep_slacks(PosedSurface& surface) {
    const std::size_t solids = model_.colliders.size();
    const std::vector<Patch>& patches = model_.laid.patches;
    ledger_->patch_slack.resize(patches.size() * solids);
    for (std::size_t c = 0; c < solids; ++c) {
      ledger_->slack.push_back(surface.apart(c));
      const std::vector<double> motions = surface.motions(c);
      for (std::size_t i = 0; i < patches.size(); ++i) {
        double& slack = ledger_->patch_slack[i * solids + c];
        if (before_) {
          const double moved = PosedSurface::of_patch(patches[i], motions);
          slack = before_->patch_slack[i * solids + c] - moved;
          if (slack > std::max(model_.law.range, 2.0 * moved)) continue;
        }
        slack = surface.apart(patches[i], c);
      }
    }
  }
  void add(const SurfaceMeeting& meeting) {
    const auto& [at, key, r] = meeting;
    const Nearness& near = at.near;
    ledger_->touches.push_back({at.triangle->index, at.at->share, near.collider,
                                near.gap + model_.margin(*at.at, near.collider), near.x, r.normal, r.force,
                                r.friction, r.sticks});
    ledger_->kept.push_back({key, r.stick_at, near.x, r.friction});
    const KeptTouch* was = before_ ? find_key(before_->kept, key) : nullptr;
    if (was)
      ledger_->friction_work += 0.5 * (r.friction + was->friction).dot(near.x - was->x);
    else
      ++ledger_->begun;
  }

  [[noreturn]] void refuse(const NearPoint& closed) const {
    refuse_closed(model_.law,
                  "the surface begins within " + model_.colliders.named(closed.near.collider) +
                      ": on triangle " + std::to_string(closed.triangle->index) + " the gap is ",
                  closed.near.gap);
  }

  const SurfaceModel& model_;
  const StateView& state_;
  const SurfaceLedger* before_;
  std::shared_ptr<SurfaceLedger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> SurfaceContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return SurfaceKeeper(*model_, state, surface_ledger_of(before.get())).keep();
}

}  // namespace tendril::contact
