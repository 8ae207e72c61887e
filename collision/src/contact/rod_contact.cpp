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
  const auto closed = each_touch(*model_, state, model_->place(state.time), [&](const Touch& at) {
    loads.force[at.node] += (1.0 - at.fraction) * at.response.force;
    loads.force[at.node + 1] += at.fraction * at.response.force;
  });
  if (closed) loads.refuse(model_->node_of(state, model_->edges[model_->points[closed->point].edge]));
}

Couplings RodContact::couplings(std::span<const NodeRange>) const {
  const auto derivatives = [model = model_.get()](const StateView& state, LoadDerivatives& to) {
    each_touch(*model, state, model->place(state.time), [&](const Touch& at) {
      const double share[2] = {1.0 - at.fraction, at.fraction};
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
          to.add_by_position(at.node + i, at.node + j, share[i] * share[j] * at.response.by_position);
          if (model->law.damping > 0.0)
            to.add_by_velocity(at.node + i, at.node + j, share[i] * share[j] * at.response.by_velocity);
        }
    });
  };
  return Couplings::within(1).with(derivatives);
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
  each_touch(*model_, state, model_->place(state.time), [&](const Touch& at) {
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
