#include <tendril/base/error.h>
#include <tendril/contact/rod_contact.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "touch.h"

namespace tendril::contact {

RodContact::RodContact(std::vector<ContactRod> rods, std::vector<Collider> colliders, const Law& law)
    : model_(std::make_unique<const RodModel>(std::move(rods), std::move(colliders), law)) {}
RodContact::~RodContact() = default;

void RodContact::add(const StateView& state, const Loads& loads) const {
  const auto closed = each_touch(*model_, state, model_->place(state), [&](const Touch& at) {
    const Vec3& force = at.response.force;
    loads.force[at.node] += (1.0 - at.fraction) * force;
    loads.force[at.node + 1] += at.fraction * force;
    if (const auto& body = model_->colliders[at.near.collider].body)
      loads.bodies[*body].add_at(at.near.x, -force, at.near.placed->position);
  });
  if (closed) loads.refuse(model_->node_of(state, model_->edges[model_->points[closed->point].edge]));
}

Couplings RodContact::couplings(std::span<const NodeRange> rods) const {
  auto derivatives = [model = model_.get()](const StateView& state, LoadDerivatives& to) {
    each_touch(*model, state, model->place(state),
               [&](const Touch& at) { add_derivatives(*model, state, at, to); });
  };
  if (model_->bodies.empty()) return Couplings::within(1).with(std::move(derivatives));
  const std::size_t nodes = rods.empty() ? 0 : rods.back().first + rods.back().count;
  std::vector<Couplings::Pair> pairs;
  for (const ContactRod& rod : model_->rods)
    for (std::size_t i = rods[rod.rod].first, end = i + rods[rod.rod].count; i < end; ++i) {
      if (i + 1 < end) pairs.emplace_back(i, i + 1);
      for (const std::size_t body : model_->bodies)
        for (const std::size_t turn : {0, 1}) pairs.emplace_back(i, nodes + 2 * body + turn);
    }
  for (const std::size_t body : model_->bodies) pairs.emplace_back(nodes + 2 * body, nodes + 2 * body + 1);
  return Couplings::between(std::move(pairs)).with(std::move(derivatives));
}

Couplings RodContact::couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const {
  for (std::size_t i = 0; i < model_->colliders.size(); ++i)
    if (const auto& body = model_->colliders[i].body; body && *body >= bodies)
      throw InvalidInput("contact.colliders[" + std::to_string(i) + "].body", std::to_string(*body),
                         "below the number of free bodies, " + std::to_string(bodies));
  return couplings(rods);
}

void RodContact::check(std::span<const NodeRange> rods) const {
  for (std::size_t i = 0; i < model_->rods.size(); ++i) {
    const ContactRod& rod = model_->rods[i];
    const std::string place = "contact.rods[" + std::to_string(i) + "]";
    if (rod.rod >= rods.size())
      throw InvalidInput(place + ".rod", std::to_string(rod.rod),
                         "below the number of rods, " + std::to_string(rods.size()));
    if (rod.rest.size() != rods[rod.rod].count)
      throw InvalidInput(place + ".rest", std::to_string(rod.rest.size()) + " points",
                         "as many as the rod has masses, " + std::to_string(rods[rod.rod].count));
  }
}

bool RodContact::has_energy() const {
  return !model_->driven && model_->law.friction == 0.0 && model_->law.damping == 0.0;
}

double RodContact::energy(const StateView& state) const {
  double sum = 0.0;
  each_touch(*model_, state, model_->place(state), [&](const Touch& at) {
    sum += at.weight * model_->law.stiffness * potential(model_->law, at.near.gap).value;
  });
  return sum;
}

bool RodContact::refuses() const {
  return model_->barrier();
}

bool RodContact::depends_on_time() const {
  return model_->driven;
}

std::vector<double> RodContact::breaks() const {
  std::vector<double> result;
  for (const Collider& collider : model_->colliders)
    result.insert(result.end(), collider.breaks.begin(), collider.breaks.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace tendril::contact
