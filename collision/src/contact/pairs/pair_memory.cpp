#include <tendril/base/error.h>

#include <algorithm>
#include <string>

#include "pair_model.h"

namespace tendril::contact {
namespace {

// A search serves while what moves stays within half the skin: some steps' motion, and no less than what it
// takes to come out of the range.
constexpr double kSkinOfRange = 4.0, kSkinOfStep = 16.0;

/// The ledger at a new accepted state.
class Keeper {
 public:
  Keeper(const PairModel& model, const StateView& state, const PairLedger* before)
      : model_(model), state_(state), before_(before), ledger_(std::make_shared<PairLedger>()) {
    ledger_->p = model.lines.positions(state);
    if (model.law.friction > 0.0 && !state.m.empty())
      for (const ContactRod& rod : model.lines.rods) {
        const Points all = state.m.subspan(state.rods[rod.rod].first, rod.rest.size());
        ledger_->m.insert(ledger_->m.end(), all.begin(), all.end());
      }
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->looked_at = before->looked_at;
    ledger_->searches = before->searches;
  }

  std::shared_ptr<const PairLedger> keep() {
    find_near();
    const auto closed =
        each_touch(model_, state_, ledger_->p, before_, [&](const PairTouch& at) { add(at); });
    if (closed && !before_) refuse(*closed);
    sort_by_key(ledger_->meetings);
    return std::move(ledger_);
  }

 private:
  void find_near() {
    const double left = before_ ? before_->near->skin - 2.0 * most_moved(before_->near->p, ledger_->p) : 0.0;
    const double step = before_ ? most_moved(before_->p, ledger_->p) : 0.0;
    if (before_ && left > 4.0 * step) {
      ledger_->near = before_->near;
    } else {
      const double skin = std::max(kSkinOfRange * model_.law.range, kSkinOfStep * step);
      ledger_->near = model_.search(ledger_->p, skin);
      ++ledger_->searches;
    }
    ledger_->slack.reserve(ledger_->near->pairs.size());
    for (const auto& [e, f] : ledger_->near->pairs) ledger_->slack.push_back(model_.slack(ledger_->p, e, f));
  }

  void add(const PairTouch& touch) {
    const auto [first, second] = std::pair(touch.at.first, touch.at.second);
    const LinePoint &x = model_.lines.points[first], &y = model_.lines.points[second];
    const LineEdge &e = model_.lines.edges[x.edge], &f = model_.lines.edges[y.edge];
    const Vec3 at = model_.point(ledger_->p, first) - touch.arm * touch.normal;
    ledger_->touches.push_back({{model_.lines.rods[e.rod].rod, model_.lines.rods[f.rod].rod},
                                {e.node, f.node},
                                {x.fraction, y.fraction},
                                touch.at.gap + model_.margin(x.edge, y.edge),
                                at,
                                touch.normal,
                                touch.force,
                                touch.friction,
                                touch.sticks});
    const std::uint64_t key = model_.key_of(touch.at);
    ledger_->meetings.push_back({key, touch.apart, touch.friction});
    const PairMeeting* met = before_ ? find_key(before_->meetings, key) : nullptr;
    if (met)
      ledger_->friction_work += 0.5 * (touch.friction + met->friction).dot(touch.slid);
    else
      ++ledger_->begun;
  }

  [[noreturn]] void refuse(const PointPair& closed) const {
    const auto named = [&](std::size_t point) {
      const LineEdge& edge = model_.lines.edges[model_.lines.points[point].edge];
      return "rod " + std::to_string(model_.lines.rods[edge.rod].rod) + " between nodes " +
             std::to_string(edge.node) + " and " + std::to_string(edge.node + 1);
    };
    refuse_closed(model_.law,
                  named(closed.first) + " begins within " + named(closed.second) + ": the gap is ",
                  closed.gap);
  }

  const PairModel& model_;
  const StateView& state_;
  const PairLedger* before_;
  std::shared_ptr<PairLedger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> RodRodContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return Keeper(*model_, state, static_cast<const PairLedger*>(before.get())).keep();
}

}  // namespace tendril::contact
