#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "contact/by_key.h"
#include "posed_self.h"

namespace tendril::contact {
namespace {

// A list serves while what moves stays within its margin: some steps' motion, and no less than what it takes
// to come out of the range. Where steps are long against patches, all of which such a margin would have near
// each other, little more than a step.
constexpr double kMarginOfRange = 4.0, kMarginOfStep = 14.0, kOfLongStep = 1.5, kOfPatch = 0.1;
// Ways are so many steps long, and grow by this where they were not left. What strayed from the last ones,
// and half as much again, is expected of the next, but no less than half of what it takes to come out of the
// range, and no more than twice that or the margin of what stays: wider margins have more near each other,
// narrower ones do not last. Ways that turn so much that vertices may stray by half of their margin are
// shorter.
constexpr double kFewestSteps = 2.25, kMostSteps = 60.0, kLonger = 1.4, kExpected = 1.5, kNarrowest = 0.5,
                 kWidest = 2.0, kBowOfMargin = 0.5;
// Pairs are kept that may come near within some steps' motion, or some ranges'.
constexpr double kLeftOfRange = 2.0, kLeftOfStep = 8.0;
// A list is made anew where a next step with so many times this one's motion would leave it, or one of so
// many times this one's length; or one that strays so much more, at most, than all so far.
constexpr double kNextStep = 1.5, kNextLength = 1.25, kMostSuddenly = 2.2;

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
        state_(state),
        surface_(model, state, before),
        ledger_(std::make_shared<SelfLedger>()) {
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->looked_at = before->looked_at;
    ledger_->searches = before->searches;
    ledger_->placed = before->placed;
    ledger_->steps = before->steps + 1.0;
    step_ = state.time - before->time;
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
    ledger_->time = state_.time;
    ledger_->p.reserve(model_.rods());
    ledger_->arm.reserve(model_.rods());
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      const Points p = surface_.masses(rod);
      ledger_->p.emplace_back(p.begin(), p.end());
      ledger_->arm.push_back(surface_.arms(rod));
    }
    ledger_->known.assign(surface_.vertices().begin(), surface_.vertices().end());
    ledger_->at.reserve(ledger_->known.size());
    for (const std::uint32_t v : ledger_->known) ledger_->at.push_back(surface_.at(v));
    ledger_->placed += static_cast<long>(ledger_->known.size());
    for (const std::uint32_t g : surface_.awake()) measure(surface_.list().groups[g]);
    sort_by_key(ledger_->near);
    if (carries_on()) {
      ledger_->list = before_->list;
      ledger_->awake = surface_.woken();
    } else {
      search();
    }
    return std::move(ledger_);
  }

 private:
  /// Whether the list of before will hold for a next step.
  bool carries_on() {
    if (!before_ || surface_.own_list()) return false;
    const SelfList& list = *before_->list;
    if (!list.holds_at(state_.time + kNextLength * step_)) return false;
    const double share = list.share(state_.time), next = list.share(state_.time + step_);
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      // What stays is left by as much as masses move in a step; from a way one strays by the square of time.
      const double times =
          share > 0.0 ? std::min(kNextStep * next * next / (share * share), kMostSuddenly) : 1.0;
      const double more = list.stays() ? kNextStep * farthest(surface_.masses(rod), before_->p[rod]) : 0.0;
      if (surface_.coarse(rod) * times + more <= list.rod_room[rod]) continue;
      const auto holds = [&](PosedSelf::By by) {
        const std::span<const double> motions = surface_.motions(rod, by);
        return std::all_of(model_.spans_of[rod].begin(), model_.spans_of[rod].end(), [&](std::uint32_t span) {
          return motions[span] * times + more <= list.margin[span];
        });
      };
      if (!holds(PosedSelf::By::masses) && !holds(PosedSelf::By::curves)) return false;
    }
    return true;
  }

  /// Everything anew from here.
  void search() {
    auto list = std::make_shared<SelfList>();
    list->from = state_.time;
    if (before_) ahead_ = steps_ahead();
    list->margin = margins();
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) surface_.curve(rod);
    const std::vector<Vec3> at = model_.place(surface_.pairs());
    std::vector<Vec3> after;
    if (!set_out(*list, after)) stay(*list);
    model_.search(at, list->stays() ? at : after, before_ ? before_->list.get() : nullptr, *list);
    find_rooms(*list);
    for (std::uint32_t g = 0; g < list->groups.size(); ++g)
      if (!(list->groups[g].slack > 0.0)) ledger_->awake.push_back(g);
    ledger_->list = std::move(list);
    ledger_->steps = 0.0;
    ++ledger_->searches;
    ledger_->placed += static_cast<long>(at.size() + after.size());
  }

  void stay(SelfList& list) {
    list.to = kInfinite;
    list.ways.clear();
    for (std::size_t rod = 0; rod < model_.rods(); ++rod)
      list.ways.push_back(model_.stay(rod, surface_.curve(rod), surface_.masses(rod), surface_.arms(rod)));
  }
  /// On the way that they came in the last step. False where there is none.
  bool set_out(SelfList& list, std::vector<Vec3>& after) {
    if (!before_ || !(step_ > 0.0)) return false;
    std::vector<CurvePair> there;
    set_out(list, there, ahead_);
    double shorter = 1.0;
    for (std::size_t rod = 0; rod < model_.rods(); ++rod)
      shorter = std::max(shorter, std::sqrt(list.ways[rod].bow / most_bow(rod, list)));
    if (shorter > 1.0) set_out(list, there, std::max(ahead_ / (1.01 * shorter), kFewestSteps));
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      if (list.ways[rod].bow <= most_bow(rod, list)) continue;
      list.ways[rod] = model_.stay(rod, surface_.curve(rod), surface_.masses(rod), surface_.arms(rod));
      there[rod] = surface_.curve(rod);
    }
    if (!(list.to > list.from) || !(list.to < kInfinite)) return false;
    after = model_.place(there);
    return all_finite(after);
  }
  void set_out(SelfList& list, std::vector<CurvePair>& there, double steps) {
    list.to = list.from + steps * step_;
    list.ways.clear();
    there.clear();
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      const Points p = surface_.masses(rod);
      const std::vector<Vec3>& arm = surface_.arms(rod);
      std::vector<Vec3> p_change(p.size()), arm_change(p.size()), p_there(p.size()), arm_there(p.size());
      for (std::size_t i = 0; i < p.size(); ++i) {
        p_change[i] = steps * (p[i] - before_->p[rod][i]);
        arm_change[i] = steps * (arm[i] - before_->arm[rod][i]);
        p_there[i] = p[i] + p_change[i];
        arm_there[i] = arm[i] + arm_change[i];
      }
      RodWay way{{p.begin(), p.end()}, arm, std::move(p_change), std::move(arm_change), {}, {}, 0.0};
      there.push_back(model_.curve(rod, p_there, arm_there));
      list.ways.push_back(model_.way(rod, surface_.curve(rod), there.back(), std::move(way)));
    }
  }
  double most_bow(std::size_t rod, const SelfList& list) const {
    return kBowOfMargin * least_margin(rod, list);
  }
  double least_margin(std::size_t rod, const SelfList& list) const {
    double least = kInfinite;
    for (const std::uint32_t span : model_.spans_of[rod]) least = std::min(least, list.margin[span]);
    return least;
  }

  /// So many steps the next ways are long: as those of the last list were, more where it was not left.
  double steps_ahead() const {
    const SelfList& last = *before_->list;
    const bool ended = !last.stays() && !last.holds_at(state_.time + kNextLength * step_);
    return std::clamp((ended ? kLonger : 1.0) * ledger_->steps + kNextLength, kFewestSteps, kMostSteps);
  }

  std::vector<double> margins() {
    const double of_range = kMarginOfRange * model_.law.range;
    std::vector<double> margin(model_.mesh.spans.size(), of_range);
    if (!before_) return margin;
    const SelfList& last = *before_->list;
    for (std::size_t rod = 0; rod < model_.rods(); ++rod) {
      const double step = farthest(surface_.masses(rod), before_->p[rod]);
      for (const std::uint32_t span : model_.spans_of[rod])
        margin[span] = std::max(margin[span], margin_for(span, step));
      if (last.stays() || surface_.own_list() || !(step_ > 0.0)) continue;
      const std::span<const double> motions = surface_.motions(rod, PosedSelf::By::curves);
      const double parts = ahead_ * step_ / (state_.time - last.from);
      for (const std::uint32_t span : model_.spans_of[rod]) {
        const double most = std::max(margin[span], kWidest * of_range);
        margin[span] = std::clamp(kExpected * motions[span] * parts * parts, kNarrowest * of_range, most);
      }
    }
    return margin;
  }

  double margin_for(std::uint32_t span, double step) const {
    return std::min(kMarginOfStep * step, std::max(kOfLongStep * step, kOfPatch * model_.patch_size[span]));
  }

  void find_rooms(SelfList& list) const {
    list.room = list.margin;
    for (const SelfGroup& group : list.groups) {
      const double half = 0.5 * std::min(group.slack, group.slack_after);
      for (const std::uint32_t patch : {group.p, group.q})
        for (const std::uint32_t span : model_.mesh.patches[patch].spans)
          list.room[span] = std::min(list.room[span], half);
    }
    list.rod_room.assign(model_.rods(), kInfinite);
    for (std::size_t i = 0; i < list.room.size(); ++i) {
      double& least = list.rod_room[model_.mesh.spans[i].pair];
      least = std::min(least, list.room[i]);
    }
  }

  /// What is near of what was looked at, that it need not be sought at each stage.
  void measure(const SelfGroup& group) {
    const double moved = surface_.moved(group);
    const NearGroup* known = surface_.known(group);
    if (known && known->left > 3.0 * moved) {
      ledger_->near.push_back({group.key(), known->pairs, known->faces, known->edges, known->left - moved});
    } else {
      const double left = std::max(kLeftOfRange * model_.law.range, kLeftOfStep * moved);
      auto pairs =
          std::make_shared<const SelfPairs>(model_.pairs(group, surface_.placed(), model_.meets() + left));
      const std::vector<double> faces(pairs->faces.size(), 0.0), edges(pairs->edges.size(), 0.0);
      ledger_->near.push_back({group.key(), std::move(pairs), faces, edges, left});
    }
    NearGroup& near = ledger_->near.back();
    const double enough = 3.0 * moved;
    const auto mend = [&](double& slack, auto&& distance) {
      slack -= moved;
      if (slack <= enough) slack = distance() - model_.meets();
    };
    const PlacedVertices at = surface_.placed();
    for (std::size_t i = 0; i < near.faces.size(); ++i)
      mend(near.faces[i], [&] { return model_.distance(near.pairs->faces[i], at); });
    for (std::size_t i = 0; i < near.edges.size(); ++i)
      mend(near.edges[i], [&] { return model_.edge_distance(near.pairs->edges[i], at); });
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
  const StateView& state_;
  double step_ = 0.0;   ///< in time, from the ledger before
  double ahead_ = 0.0;  ///< so many steps the next ways are long
  PosedSelf surface_;
  std::shared_ptr<SelfLedger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> SurfaceSelfContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return SelfKeeper(*model_, state, self_ledger_of(before.get())).keep();
}

}  // namespace tendril::contact
