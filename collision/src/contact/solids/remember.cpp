#include <tendril/base/error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "touch.h"

namespace tendril::contact {
namespace {

/// The ledger at a new accepted state: a slack less what has moved since, measured anew where little is left.
class Keeper {
 public:
  Keeper(const RodModel& model, const StateView& state, const Ledger* before)
      : model_(model), state_(state), before_(before), ledger_(std::make_shared<Ledger>()) {
    ledger_->placed = model.colliders.place(state);
    ledger_->p = model.lines.positions(state);
    if (!before) return;
    ledger_->friction_work = before->friction_work;
    ledger_->begun = before->begun;
    ledger_->looked_at = before->looked_at;
  }

  std::shared_ptr<const Ledger> keep() {
    measure_slacks();
    StateView at_end = state_;
    at_end.memory = before_;
    const auto closed = each_touch(model_, at_end, ledger_->placed, [&](const Touch& at) { add(at); });
    if (closed && !before_) refuse(*closed);
    // Points are met edge by edge and, on an edge, solid by solid: an edge between two of them mixes the
    // keys.
    sort_by_key(ledger_->touches);
    return std::move(ledger_);
  }

 private:
  void measure_slacks() {
    const std::size_t solids = model_.colliders.size();
    ledger_->slack.resize(model_.lines.edges.size() * solids);
    for (std::size_t e = 0; e < model_.lines.edges.size(); ++e)
      for (std::size_t c = 0; c < solids; ++c) ledger_->slack[e * solids + c] = slack(e, c);
  }

  double slack(std::size_t e, std::size_t c) {
    const LineEdge& edge = model_.lines.edges[e];
    if (before_) {
      const std::size_t node = model_.lines.node_of(state_, edge);
      const double moved =
          model_.moved(*before_, edge, state_.p[node], state_.p[node + 1], c, ledger_->placed[c]);
      const double left = before_->slack[e * model_.colliders.size() + c] - moved;
      if (left > std::max(model_.law.range, 2.0 * moved)) return left;
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = edge.first; i < edge.end; ++i)
      least = std::min(least, model_.nearness(state_, i, c, ledger_->placed[c]).gap);
    ledger_->looked_at += static_cast<long>(edge.end - edge.first);
    return least - model_.law.range;
  }

  void add(const Touch& at) {
    const LinePoint& point = model_.lines.points[at.near.point];
    const LineEdge& edge = model_.lines.edges[point.edge];
    const double margin = model_.margin[point.edge * model_.colliders.size() + at.near.collider];
    const Response& r = at.response;
    ledger_->contacts.push_back({model_.lines.rods[edge.rod].rod, edge.node, at.fraction, at.near.collider,
                                 at.near.gap + margin, at.near.x, r.normal, r.force, r.friction, r.sticks});
    ledger_->touches.push_back({at.key, r.stick_at, at.near.x, r.friction});
    const KeptTouch* was = before_ ? find_key(before_->touches, at.key) : nullptr;
    if (was)
      ledger_->friction_work += 0.5 * (r.friction + was->friction).dot(at.near.x - was->x);
    else
      ++ledger_->begun;
  }

  [[noreturn]] void refuse(const Nearness& closed) const {
    const LineEdge& edge = model_.lines.edges[model_.lines.points[closed.point].edge];
    refuse_closed(model_.law,
                  "rod " + std::to_string(model_.lines.rods[edge.rod].rod) + " begins within " +
                      model_.colliders.named(closed.collider) + ": between nodes " +
                      std::to_string(edge.node) + " and " + std::to_string(edge.node + 1) + " the gap is ",
                  closed.gap);
  }

  const RodModel& model_;
  const StateView& state_;
  const Ledger* before_;
  std::shared_ptr<Ledger> ledger_;
};

}  // namespace

std::shared_ptr<const ForceMemory> RodContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  return Keeper(*model_, state, ledger_of(before.get())).keep();
}

}  // namespace tendril::contact
