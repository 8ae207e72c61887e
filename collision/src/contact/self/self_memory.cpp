#include <tendril/base/error.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "contact/by_key.h"
#include "contact/foot.h"
#include "posed_self.h"

namespace tendril::contact {
namespace {

// A search serves while what moves stays within its margin: some steps' motion, and no less than what it
// takes to come out of the range.
constexpr double kMarginOfRange = 4.0, kMarginOfStep = 16.0;

/// The ledger at a new accepted state.
class SelfKeeper {
 public:
  SelfKeeper(const SelfModel& model, const StateView& state, const SelfLedger* before)
      : model_(model), state_(state), before_(before), ledger_(std::make_shared<SelfLedger>()) {
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->looked_at = before->looked_at;
    ledger_->searches = before->searches;
    ledger_->placed = before->placed;
  }

  std::shared_ptr<const SelfLedger> keep() {
    PosedSelf surface(model_, state_, before_, true);
    if (!surface.sound())
      throw InvalidInput("contact.surface", "vertices that cannot be computed",
                         "closer to the origin than 1e150");
    const SelfMeetings meetings = meetings_of(model_, surface, before_);
    if (meetings.closed && !before_) refuse(*meetings.closed);
    ledger_->looked_at += meetings.looked_at;
    for (const SelfResponse& meeting : meetings.all) add(meeting, surface);
    sort_by_key(ledger_->meetings);
    // Last, since touches are those of the list and the ledger before.
    ledger_->nodes = model_.nodes(state_);
    ledger_->pose = model_.pose(std::move(surface.pairs()));
    if (serves(surface))
      carry_on(surface);
    else
      search(surface.motions());
    return std::move(ledger_);
  }

 private:
  /// The list of the last accepted state holds here, and is likely to for some steps more.
  bool serves(const PosedSelf& surface) {
    if (!before_ || surface.share_list() != before_->list) return false;
    ledger_->since_search = model_.motions(before_->list->pose, ledger_->pose.pairs);
    for (std::size_t i = 0; i < ledger_->since_search.size(); ++i)
      if (!(before_->list->margin[i] - ledger_->since_search[i] > 2.0 * surface.motions()[i])) return false;
    return true;
  }

  void search(const std::vector<double>& step) {
    const std::vector<Vec3> at = model_.place(ledger_->pose.pairs);
    std::vector<double> margin(model_.mesh.spans.size(), kMarginOfRange * model_.law.range);
    for (std::size_t i = 0; i < step.size(); ++i) margin[i] = std::max(margin[i], kMarginOfStep * step[i]);
    ledger_->list = model_.search(ledger_->pose, at, std::move(margin));
    ledger_->since_search.assign(model_.mesh.spans.size(), 0.0);
    for (const SelfGroup& group : ledger_->list->groups) ledger_->slack.push_back(group.slack);
    ledger_->pair_slack = ledger_->list->slack;
    ++ledger_->searches;
    ledger_->placed += static_cast<long>(at.size());
    ledger_->known = ledger_->list->used;
    for (const std::uint32_t v : ledger_->known) ledger_->at.push_back(at[v]);
  }

  /// What was left less what has moved since, measured anew where something is awake: bounds add up from step
  /// to step and would wake everything in time.
  void carry_on(PosedSelf& surface) {
    ledger_->list = before_->list;
    const auto& groups = ledger_->list->groups;
    ledger_->slack = before_->slack;
    ledger_->pair_slack = before_->pair_slack;
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      const double moved = surface.moved(groups[g]);
      ledger_->slack[g] -= moved;
      const auto [faces, edges] = slacks_of(g);
      for (double& slack : faces) slack -= moved;
      for (double& slack : edges) slack -= moved;
    }
    for (const std::uint32_t g : surface.awake()) ledger_->slack[g] = measure(surface, g);
    ledger_->known.assign(surface.vertices().begin(), surface.vertices().end());
    for (const std::uint32_t v : ledger_->known) ledger_->at.push_back(surface.at(v));
    ledger_->placed += static_cast<long>(ledger_->known.size());
  }
  std::pair<std::span<double>, std::span<double>> slacks_of(std::uint32_t g) {
    const SelfGroup& group = ledger_->list->groups[g];
    const SelfGroup before = g == 0 ? SelfGroup{} : ledger_->list->groups[g - 1];
    PairSlacks& all = ledger_->pair_slack;
    return {std::span(all.faces).subspan(before.faces, group.faces - before.faces),
            std::span(all.edges).subspan(before.edges, group.edges - before.edges)};
  }

  /// Distances of what could have come near; the others' stay as bounded.
  double measure(const PosedSelf& surface, std::uint32_t g) {
    const SelfList& list = surface.list();
    const SelfGroup before = g == 0 ? SelfGroup{} : list.groups[g - 1];
    const auto at = [&](std::uint32_t v) -> const Vec3& { return surface.at(v); };
    double least = std::numeric_limits<double>::infinity();
    const double enough = 2.0 * surface.moved(list.groups[g]);
    const auto [faces, edges] = slacks_of(g);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (faces[i] <= enough) {
        const auto& [v, f] = list.faces[before.faces + i];
        const auto& [a, b, c] = model_.surface.triangles[f];
        faces[i] = (at(v) - foot_on({at(a), at(b), at(c)}, at(v)).point).norm() - model_.meets();
      }
      least = std::min(least, faces[i]);
    }
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (edges[i] <= enough) {
        const auto& [e, f] = list.edges[before.edges + i];
        const auto& [a, b] = model_.mesh.edges[e].end;
        const auto& [c, d] = model_.mesh.edges[f].end;
        const SegmentFeet feet = feet_of(at(a), at(b), at(c), at(d));
        edges[i] = apart(feet, at(a), at(b), at(c), at(d)).norm() - model_.meets();
      }
      least = std::min(least, edges[i]);
    }
    return least;
  }

  void add(const SelfResponse& meeting, const PosedSelf& surface) {
    const SelfNear& near = meeting.at;
    Vec3 first = Vec3::Zero();
    for (std::size_t i = 0; i < near.of_first; ++i) first += near.weight[i] * surface.at(near.vertex[i]);
    std::array<std::uint32_t, 2> face = near.face;
    if (near.of_first == 1) face[0] = model_.mesh.face_of[near.vertex[0]];
    ledger_->touches.push_back({face, meeting.gap, first - 0.5 * near.apart, meeting.normal, meeting.force,
                                meeting.friction, meeting.sticks});
    ledger_->meetings.push_back({near.key, meeting.apart, meeting.friction});
    const SelfMeeting* met = before_ ? find_key(before_->meetings, near.key) : nullptr;
    if (met)
      ledger_->friction_work += 0.5 * (meeting.friction + met->friction).dot(meeting.slid);
    else
      ++ledger_->begun;
  }

  [[noreturn]] void refuse(const SelfClosed& closed) const {
    throw InvalidInput("contact",
                       "the surface begins in contact with itself: triangles " +
                           std::to_string(closed.face[0]) + " and " + std::to_string(closed.face[1]) +
                           ", the gap between their skins is " + std::to_string(closed.gap),
                       "an open gap");
  }

  const SelfModel& model_;
  const StateView& state_;
  const SelfLedger* before_;
  std::shared_ptr<SelfLedger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> SurfaceSelfContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return SelfKeeper(*model_, state, self_ledger_of(before.get())).keep();
}

}  // namespace tendril::contact
