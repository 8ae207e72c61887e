#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "contact/by_key.h"
#include "posed_self.h"

namespace tendril::contact {
namespace {

// A list serves while what moves stays within its margin: some steps' motion, and no less than what it takes
// to come out of the range. Where steps are long against patches, all of which such a margin would have near
// each other, little more than a step: to search each time costs less than to look at so much at each stage.
constexpr double kMarginOfRange = 4.0, kMarginOfStep = 14.0, kOfLongStep = 1.5, kOfPatch = 0.1;
// What of a rod's room its motion may take before it is looked at by its curves, and stands anew.
constexpr double kOfRoom = 0.7;
// Pairs are kept that may come near within some steps' motion, or some ranges'.
constexpr double kLeftOfRange = 2.0, kLeftOfStep = 8.0;
// A list is made anew where a next step with so many times this one's motion of masses would leave it, or
// this share of its margin is all that is left.
constexpr double kNextStep = 4.0, kLeastLeft = 0.6;

double farthest(Points a, Points b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).squaredNorm());
  return std::sqrt(most);
}

/// The ledger at a new accepted state.
class SelfKeeper {
 public:
  SelfKeeper(const SelfModel& model, const StateView& state, const SelfLedger* before)
      : model_(model),
        before_(before),
        surface_(model, state, before),
        ledger_(std::make_shared<SelfLedger>()) {
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->looked_at = before->looked_at;
    ledger_->searches = before->searches;
    ledger_->placed = before->placed;
    ledger_->steps = before->steps + 1;
  }

  std::shared_ptr<const SelfLedger> keep() {
    if (!surface_.sound())
      throw InvalidInput("contact.surface", "vertices that cannot be computed",
                         "closer to the origin than 1e150");
    const SelfMeetings meetings = meetings_of(model_, surface_, before_);
    if (meetings.closed && !before_) refuse(*meetings.closed);
    ledger_->looked_at += meetings.looked_at;
    for (const SelfResponse& meeting : meetings.all) add(meeting);
    sort_by_key(ledger_->meetings);
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      const Points p = surface_.masses(rod);
      ledger_->p.emplace_back(p.begin(), p.end());
      ledger_->arm.push_back(surface_.arms(rod));
    }
    ledger_->known.assign(surface_.vertices().begin(), surface_.vertices().end());
    for (const std::uint32_t v : ledger_->known) ledger_->at.push_back(surface_.at(v));
    ledger_->placed += static_cast<long>(ledger_->known.size());
    if (!before_ || surface_.own_list() || !carry_on()) search();
    return std::move(ledger_);
  }

 private:
  RodPose pose(std::size_t rod) {
    return model_.pose(rod, surface_.curve(rod), surface_.masses(rod), surface_.arms(rod));
  }

  /// Everything anew from here.
  void search() {
    ledger_->near.clear();
    ledger_->base.clear();
    for (std::size_t rod = 0; rod < model_.rods(); ++rod)
      ledger_->base.push_back(std::make_shared<const RodPose>(pose(rod)));
    const std::vector<Vec3> at = model_.place(surface_.pairs());
    ledger_->list = model_.search(at, margins());
    ledger_->searched = ledger_->base;
    ledger_->since.assign(model_.mesh.spans.size(), 0.0);
    ledger_->path.assign(model_.mesh.patches.size(), 0.0);
    std::vector<double> budget;
    for (const SelfGroup& group : ledger_->list->groups) budget.push_back(group.slack);
    ledger_->budget = std::make_shared<const std::vector<double>>(std::move(budget));
    ledger_->steps = 0;
    ledger_->room.assign(model_.mesh.spans.size(), kInfinite);
    std::vector<std::uint32_t> all(model_.rods());
    std::iota(all.begin(), all.end(), 0U);
    find_rooms(all);
    ++ledger_->searches;
    ledger_->placed += static_cast<long>(at.size());
  }
  std::vector<double> margins() {
    std::vector<double> margin(model_.mesh.spans.size(), kMarginOfRange * model_.law.range);
    if (!before_) return margin;
    std::vector<double> moved(margin.size(), 0.0);
    const double steps = static_cast<double>(before_->steps + 1);
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      model_.motions(rod, *before_->searched[rod], surface_.curve(rod), moved);
      for (const std::uint32_t span : model_.spans_of[rod])
        if (moved[span] < kInfinite)
          margin[span] = std::max(margin[span], margin_for(span, moved[span] / steps));
    }
    return margin;
  }

  double margin_for(std::uint32_t span, double step) const {
    return std::min(kMarginOfStep * step, std::max(kOfLongStep * step, kOfPatch * model_.patch_size[span]));
  }

  /// Within which of its base nothing that a span holds comes near, whatever the others do within theirs.
  void find_rooms(const std::vector<std::uint32_t>& rods) {
    for (const std::uint32_t rod : rods)
      for (const std::uint32_t span : model_.spans_of[rod])
        ledger_->room[span] = ledger_->list->margin[span] - ledger_->since[span];
    for (const std::uint32_t rod : rods)
      for (const std::uint32_t g : ledger_->list->with(rod)) {
        const double half = 0.5 * ledger_->slack(g);
        for (const std::uint32_t patch : {ledger_->list->groups[g].p, ledger_->list->groups[g].q})
          for (const std::uint32_t span : model_.mesh.patches[patch].spans)
            ledger_->room[span] = std::min(ledger_->room[span], half);
      }
    ledger_->rod_room.assign(model_.rods(), kInfinite);
    for (std::size_t i = 0; i < ledger_->room.size(); ++i) {
      double& least = ledger_->rod_room[model_.mesh.spans[i].pair];
      least = std::min(least, ledger_->room[i]);
    }
  }

  /// The list of before; rods that moved on, and those of groups that were looked at, stand anew.
  /// \return false where the list will not hold for long
  bool carry_on() {
    ledger_->list = before_->list;
    ledger_->base = before_->base;
    ledger_->searched = before_->searched;
    ledger_->since = before_->since;
    ledger_->path = before_->path;
    ledger_->budget = before_->budget;
    ledger_->room = before_->room;
    std::vector<std::uint32_t> moves;
    for (std::uint32_t rod = 0; rod < model_.rods(); ++rod)
      if (moved_on(rod)) moves.push_back(rod);
    const std::vector<std::uint32_t> near = surface_.rods_of_awake();
    moves.insert(moves.end(), near.begin(), near.end());
    sort_once(moves);
    if (!stand_anew(moves)) return false;
    if (!surface_.awake().empty()) measure();
    find_rooms(moves);
    return true;
  }
  bool moved_on(std::size_t rod) {
    if (surface_.bounded(rod) == PosedSelf::By::curves) return true;
    if (surface_.coarse(rod) <= kOfRoom * before_->rod_room[rod]) return false;
    const std::span<const double> motions = surface_.motions(rod, PosedSelf::By::masses);
    return std::any_of(model_.spans_of[rod].begin(), model_.spans_of[rod].end(),
                       [&](std::uint32_t span) { return !(motions[span] <= kOfRoom * before_->room[span]); });
  }
  bool stand_anew(const std::vector<std::uint32_t>& rods) {
    std::vector<double> way(model_.mesh.spans.size(), 0.0), far(way.size(), kInfinite);
    std::vector<std::uint32_t> patches;
    for (const std::uint32_t rod : rods) {
      const std::span<const double> motions = surface_.motions(rod, PosedSelf::By::curves);
      if (half_used(rod, motions)) model_.motions(rod, *before_->searched[rod], surface_.curve(rod), far);
      const double next = kNextStep * farthest(surface_.masses(rod), before_->p[rod]);
      for (const std::uint32_t span : model_.spans_of[rod]) {
        way[span] = motions[span];
        ledger_->since[span] = std::min(ledger_->since[span] + way[span], far[span]);
        const double margin = ledger_->list->margin[span];
        if (!(margin - ledger_->since[span] > std::min(next, kLeastLeft * margin))) return false;
      }
      patches.insert(patches.end(), model_.patches_of[rod].begin(), model_.patches_of[rod].end());
      ledger_->base[rod] = std::make_shared<const RodPose>(pose(rod));
    }
    sort_once(patches);
    for (const std::uint32_t patch : patches) ledger_->path[patch] += model_.of_patch(patch, way);
    return true;
  }

  /// Then it pays to ask how far the rod is from where it was searched, since ways there and back add up.
  bool half_used(std::uint32_t rod, std::span<const double> motions) const {
    return std::any_of(model_.spans_of[rod].begin(), model_.spans_of[rod].end(), [&](std::uint32_t span) {
      return before_->since[span] + motions[span] > 0.5 * before_->list->margin[span];
    });
  }

  /// How near what was looked at is: bounds add up from step to step and would wake everything in time.
  void measure() {
    std::vector<double> budget = *before_->budget;
    for (const std::uint32_t g : surface_.awake()) {
      const SelfGroup& group = ledger_->list->groups[g];
      budget[g] = measure(g, group) + ledger_->path[group.p] + ledger_->path[group.q];
    }
    ledger_->budget = std::make_shared<const std::vector<double>>(std::move(budget));
  }
  double measure(std::uint32_t g, const SelfGroup& group) {
    const double moved = surface_.moved(group);
    const NearGroup* known = surface_.known(g);
    if (known && known->left > 3.0 * moved) {
      ledger_->near.push_back({g, known->pairs, known->faces, known->edges, known->left - moved});
    } else {
      const double left = std::max(kLeftOfRange * model_.law.range, kLeftOfStep * moved);
      auto pairs =
          std::make_shared<const SelfPairs>(model_.pairs(group, surface_.placed(), model_.meets() + left));
      const std::vector<double> faces(pairs->faces.size(), 0.0), edges(pairs->edges.size(), 0.0);
      ledger_->near.push_back({g, std::move(pairs), faces, edges, left});
    }
    NearGroup& near = ledger_->near.back();
    double least = near.left;
    const double enough = 3.0 * moved;
    const auto mend = [&](double& slack, auto&& distance) {
      slack -= moved;
      if (slack <= enough) slack = distance() - model_.meets();
      least = std::min(least, slack);
    };
    const PlacedVertices at = surface_.placed();
    for (std::size_t i = 0; i < near.faces.size(); ++i)
      mend(near.faces[i], [&] { return model_.distance(near.pairs->faces[i], at); });
    for (std::size_t i = 0; i < near.edges.size(); ++i)
      mend(near.edges[i], [&] { return model_.edge_distance(near.pairs->edges[i], at); });
    return least;
  }

  void add(const SelfResponse& meeting) {
    const SelfNear& near = meeting.at;
    Vec3 first = Vec3::Zero();
    for (std::size_t i = 0; i < near.of_first; ++i) first += near.weight[i] * surface_.at(near.vertex[i]);
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
    refuse_closed(model_.law,
                  "the surface begins in contact with itself: triangles " + std::to_string(closed.face[0]) +
                      " and " + std::to_string(closed.face[1]) + ", the gap between their skins is ",
                  closed.gap);
  }

  const SelfModel& model_;
  const SelfLedger* before_;
  PosedSelf surface_;
  std::shared_ptr<SelfLedger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> SurfaceSelfContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return SelfKeeper(*model_, state, self_ledger_of(before.get())).keep();
}

}  // namespace tendril::contact
