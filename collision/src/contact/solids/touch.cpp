#include "touch.h"

#include <algorithm>

namespace tendril::contact {
namespace {

/// Derivatives of a force f on a point at r from a body's centre, by the body's place, turn, velocity and
/// spin. The law f(x - c, v - u - omega x r) turns with the body:
/// df/dphi = -[f] + K [r] + D [v - u - omega x r], K by the point's place alone and D by its velocity.
struct ByBody {
  Mat3 place, turn, velocity, spin;

  ByBody(const Response& response, const Vec3& r, const Vec3& apart, const Vec3& omega)
      : place(-response.by_position), velocity(-response.by_velocity) {
    const Mat3 k = response.by_position + response.by_velocity * cross_matrix(omega);
    turn = -cross_matrix(response.force) + k * cross_matrix(r) + response.by_velocity * cross_matrix(apart);
    spin = response.by_velocity * cross_matrix(r);
  }
};

/// The part of a touch that a free body has: its wrench is (-f, -r x f).
void add_body(const StateView& state, const Touch& at, std::size_t body, LoadDerivatives& to) {
  const Vec3 r = at.near.x - at.near.placed->position;
  const Vec3 velocity = between(state.v[at.node], state.v[at.node + 1], at.fraction);
  const Vec3 apart = velocity - at.near.placed->velocity_at(at.near.x);
  const ByBody by(at.response, r, apart, at.near.placed->spin);
  const Mat3 arm = cross_matrix(r), f = cross_matrix(at.response.force);
  const std::size_t place = state.p.size() + 2 * body, turn = place + 1;
  const double share[2] = {1.0 - at.fraction, at.fraction};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t node = at.node + i;
    to.add_by_position(node, place, share[i] * by.place);
    to.add_by_position(node, turn, share[i] * by.turn);
    to.add_by_velocity(node, place, share[i] * by.velocity);
    to.add_by_velocity(node, turn, share[i] * by.spin);
    to.add_by_position(place, node, -share[i] * at.response.by_position);
    to.add_by_velocity(place, node, -share[i] * at.response.by_velocity);
    to.add_by_position(turn, node, share[i] * (f - arm * at.response.by_position));
    to.add_by_velocity(turn, node, -share[i] * arm * at.response.by_velocity);
  }
  to.add_by_position(place, place, -by.place);
  to.add_by_position(place, turn, -by.turn);
  to.add_by_velocity(place, place, -by.velocity);
  to.add_by_velocity(place, turn, -by.spin);
  to.add_by_position(turn, place, -f - arm * by.place);
  to.add_by_position(turn, turn, -arm * by.turn);
  to.add_by_velocity(turn, place, -arm * by.velocity);
  to.add_by_velocity(turn, turn, -arm * by.spin);
}

}  // namespace

void add_derivatives(const RodModel& model, const StateView& state, const Touch& at, LoadDerivatives& to) {
  const double share[2] = {1.0 - at.fraction, at.fraction};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      to.add_by_position(at.node + i, at.node + j, share[i] * share[j] * at.response.by_position);
      to.add_by_velocity(at.node + i, at.node + j, share[i] * share[j] * at.response.by_velocity);
    }
  if (const auto& body = model.colliders[at.near.collider].body) add_body(state, at, *body, to);
}

Touch touch(const RodModel& model, const StateView& state, const Ledger* kept, const Nearness& near) {
  const LinePoint& at = model.lines.points[near.point];
  const std::size_t node = model.lines.node_of(state, model.lines.edges[at.edge]);
  const std::uint64_t key = near.point * model.colliders.size() + near.collider;
  std::optional<Vec3> from;
  if (kept && model.law.friction > 0.0) {
    // What comes into the range within a step is held where it was when the step began: it slides from there.
    const KeptTouch* was = find_key(kept->touches, key);
    from = was ? was->stick_at : model.local_before(*kept, at, near.collider);
  }
  const Vec3 velocity = between(state.v[node], state.v[node + 1], at.fraction);
  return {near,
          node,
          at.fraction,
          at.weight,
          key,
          respond(*model.colliders[near.collider].shape, model.law, at.weight, near, from, velocity)};
}

}  // namespace tendril::contact
