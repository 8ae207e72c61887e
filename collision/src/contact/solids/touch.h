#pragma once

#include "rod_model.h"

namespace tendril::contact {

/// A point in the range of a solid.
struct Touch {
  Nearness near;
  std::size_t node;  ///< flat, the first of the point's edge
  double fraction, weight;
  std::uint64_t key;  ///< of its KeptTouch
  Response response;
};

inline const Ledger* ledger_of(const ForceMemory* memory) {
  return static_cast<const Ledger*>(memory);
}

/// Adds the derivatives of what a touch does to its nodes, and to its solid where that is a free body.
void add_derivatives(const RodModel& model, const StateView& state, const Touch& at, LoadDerivatives& to);

/// The response to a point within the range.
Touch touch(const RodModel& model, const StateView& state, const Ledger* kept, const Nearness& near);

/// Calls visit(Touch) for every point within the range, in order. Ends at the first
/// point that a barrier cannot let be where it is, and returns it; empty where there is none.
template <class Visit>
std::optional<Nearness> each_touch(const RodModel& model, const StateView& state,
                                   const std::vector<Placement>& placed, Visit&& visit) {
  const Ledger* kept = ledger_of(state.memory);
  std::optional<Nearness> closed;
  model.each_near(state, placed, kept, [&](const Nearness& near) {
    if (model.barrier() && (!(near.gap > 0.0) || (kept && !model.reachable(*kept, near)))) {
      closed = near;
      return false;
    }
    if (near.gap < model.law.range) visit(touch(model, state, kept, near));
    return true;
  });
  return closed;
}

}  // namespace tendril::contact
