#include <tendril/base/error.h>
#include <tendril/contact/rod_contact.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "contact/couple.h"
#include "touch.h"

namespace tendril::contact {
namespace {

/// The nodes of edges that touch something, and what they touch where it is free.
LocalCouplings acting_at(const RodModel& model, const StateView& state) {
  LocalCouplings result;
  std::pair<std::size_t, std::size_t> last{~std::size_t{0}, 0};
  each_touch(model, state, model.colliders.place(state), [&](const Touch& at) {
    // Points follow each other along an edge.
    const std::pair here(at.node, at.near.collider);
    if (std::exchange(last, here) == here) return;
    std::vector<std::size_t> nodes{at.node, at.node + 1};
    if (const auto& body = model.colliders[at.near.collider].body)
      for (const std::size_t turn : {0, 1}) nodes.push_back(state.p.size() + 2 * *body + turn);
    couple(nodes, result);
  });
  return result;
}

}  // namespace

RodContact::RodContact(std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law)
    : model_(std::make_unique<const RodModel>(std::move(rods), std::move(colliders), law)) {}
RodContact::~RodContact() = default;

void RodContact::add(const StateView& state, const Loads& loads) const {
  const auto closed = each_touch(*model_, state, model_->colliders.place(state), [&](const Touch& at) {
    const Vec3& force = at.response.force;
    loads.force[at.node] += (1.0 - at.fraction) * force;
    loads.force[at.node + 1] += at.fraction * force;
    if (const auto& body = model_->colliders[at.near.collider].body)
      loads.bodies[*body].add_at(at.near.x, -force, at.near.placed->position);
  });
  const RodLines& lines = model_->lines;
  if (closed) loads.refuse(lines.node_of(state, lines.edges[lines.points[closed->point].edge]));
}

Couplings RodContact::couplings(std::span<const NodeRange> rods) const {
  auto derivatives = [model = model_.get()](const StateView& state, LoadDerivatives& to) {
    each_touch(*model, state, model->colliders.place(state),
               [&](const Touch& at) { add_derivatives(*model, state, at, to); });
  };
  if (model_->colliders.bodies.empty()) return Couplings::within(1).with(std::move(derivatives));
  const std::size_t nodes = rods.empty() ? 0 : rods.back().first + rods.back().count;
  std::vector<Couplings::Pair> pairs;
  for (const ContactRod& rod : model_->lines.rods)
    for (std::size_t i = rods[rod.rod].first, end = i + rods[rod.rod].count; i < end; ++i) {
      if (i + 1 < end) pairs.emplace_back(i, i + 1);
      for (const std::size_t body : model_->colliders.bodies)
        for (const std::size_t turn : {0, 1}) pairs.emplace_back(i, nodes + 2 * body + turn);
    }
  for (const std::size_t body : model_->colliders.bodies)
    pairs.emplace_back(nodes + 2 * body, nodes + 2 * body + 1);
  return Couplings::between(std::move(pairs))
      .at_states([model = model_.get()](const StateView& state) { return acting_at(*model, state); })
      .with(std::move(derivatives));
}

Couplings RodContact::couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const {
  model_->colliders.check_bodies(bodies);
  return couplings(rods);
}

void RodContact::check(std::span<const NodeRange> rods) const {
  model_->lines.check(rods);
}

bool RodContact::has_energy() const {
  return !model_->colliders.driven && conservative(model_->law);
}

double RodContact::energy(const StateView& state) const {
  double sum = 0.0;
  each_touch(*model_, state, model_->colliders.place(state), [&](const Touch& at) {
    sum += at.weight * model_->law.stiffness * potential(model_->law, at.near.gap).value;
  });
  return sum;
}

bool RodContact::refuses() const {
  return model_->barrier();
}

bool RodContact::depends_on_time() const {
  return model_->colliders.driven;
}

std::vector<double> RodContact::breaks() const {
  return model_->colliders.breaks();
}

}  // namespace tendril::contact
