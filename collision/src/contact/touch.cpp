#include "touch.h"

#include <algorithm>

namespace tendril::contact {
namespace {

/// Where a point sticks: where it did, or where it was at the last accepted state.
Vec3 stuck_at(const RodModel& model, const Ledger& kept, const LinePoint& at, std::uint64_t key,
              std::size_t collider) {
  const auto found = std::lower_bound(kept.stuck.begin(), kept.stuck.end(), key,
                                      [](const StickPoint& a, std::uint64_t k) { return a.key < k; });
  if (found != kept.stuck.end() && found->key == key) return found->at;
  return model.local_before(kept, at, collider);
}

}  // namespace

Touch touch(const RodModel& model, const StateView& state, const Ledger* kept, const Nearness& near) {
  const LinePoint& at = model.points[near.point];
  const std::size_t node = model.node_of(state, model.edges[at.edge]);
  const std::uint64_t key = near.point * model.colliders.size() + near.collider;
  std::optional<Vec3> from;
  if (kept && model.law.friction > 0.0) from = stuck_at(model, *kept, at, key, near.collider);
  const Vec3 velocity = RodModel::between(state.v[node], state.v[node + 1], at.fraction);
  return {near,
          node,
          at.fraction,
          at.weight,
          key,
          respond(*model.colliders[near.collider].shape, model.law, at.weight, model.stick, near, from,
                  velocity)};
}

}  // namespace tendril::contact
