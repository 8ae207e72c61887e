#include <tendril/base/error.h>
#include <tendril/contact/body_contact.h>

#include <algorithm>
#include <string>
#include <utility>

#include "body_model.h"

namespace tendril::contact {
namespace {

const BodyLedger* ledger_of(const ForceMemory* memory) {
  return static_cast<const BodyLedger*>(memory);
}

/// The body that a closed gap is told of, as a flat index.
std::size_t index_of(const BodyModel& model, const StateView& state, const Nearness& closed) {
  return state.p.size() + 2 * *model.colliders[model.points[closed.point].collider].body;
}

/// The places and turns of bodies that meet each other, or what is not free, in pairs.
class CoupledBodies {
 public:
  CoupledBodies(const BodyModel& model, std::size_t nodes) : model_(model), nodes_(nodes) {}
  void add(std::size_t own, std::size_t collider) {
    const std::size_t first = nodes_ + 2 * *model_.colliders[own].body;
    pairs_.emplace_back(first, first + 1);
    if (!model_.colliders[collider].body) return;
    const std::size_t second = nodes_ + 2 * *model_.colliders[collider].body;
    pairs_.emplace_back(second, second + 1);
    for (const std::size_t a : {first, first + 1})
      for (const std::size_t b : {second, second + 1}) pairs_.emplace_back(a, b);
  }
  /// Each once.
  std::vector<Couplings::Pair> take() {
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    return std::move(pairs_);
  }

 private:
  const BodyModel& model_;
  std::size_t nodes_;
  std::vector<Couplings::Pair> pairs_;
};

[[noreturn]] void refuse(const BodyModel& model, const Nearness& closed) {
  const std::size_t first = model.points[closed.point].collider;
  refuse_closed(model.law,
                model.colliders.named(first) + " begins within " + model.colliders.named(closed.collider) +
                    ": the gap is ",
                closed.gap);
}

}  // namespace

BodyContact::BodyContact(std::vector<Collider> colliders, const Law& law)
    : model_(std::make_unique<const BodyModel>(std::move(colliders), law)) {}
BodyContact::~BodyContact() = default;

void BodyContact::add(const StateView& state, const Loads& loads) const {
  const std::vector<Placement> placed = model_->colliders.place(state);
  const auto closed = model_->each_touch(placed, ledger_of(state.memory), [&](const BodyContactPoint& at) {
    const Collider &first = model_->colliders[model_->points[at.near.point].collider],
                   &second = model_->colliders[at.near.collider];
    loads.bodies[*first.body].add_at(at.surface, at.response.force, state.bodies[*first.body].position);
    if (second.body)
      loads.bodies[*second.body].add_at(at.surface, -at.response.force, state.bodies[*second.body].position);
  });
  if (closed) loads.refuse(index_of(*model_, state, *closed));
}

Couplings BodyContact::couplings(std::span<const NodeRange> rods) const {
  const std::size_t nodes = rods.empty() ? 0 : rods.back().first + rods.back().count;
  CoupledBodies ever(*model_, nodes);
  for (const BodyPair& pair : model_->pairs) ever.add(pair.first, pair.second);
  return Couplings::between(ever.take()).at_states([model = model_.get()](const StateView& state) {
    CoupledBodies here(*model, state.p.size());
    model->each_touch(model->colliders.place(state), ledger_of(state.memory),
                      [&](const BodyContactPoint& at) {
                        here.add(model->points[at.near.point].collider, at.near.collider);
                      });
    return LocalCouplings{here.take(), {}};
  });
}

Couplings BodyContact::couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const {
  model_->colliders.check_bodies(bodies);
  return couplings(rods);
}

bool BodyContact::has_energy() const {
  return !model_->colliders.driven && conservative(model_->law);
}

double BodyContact::energy(const StateView& state) const {
  double sum = 0.0;
  model_->each_touch(model_->colliders.place(state), ledger_of(state.memory),
                     [&](const BodyContactPoint& at) {
                       sum += model_->points[at.near.point].weight * model_->law.stiffness *
                              potential(model_->law, at.near.gap).value;
                     });
  return sum;
}

bool BodyContact::refuses() const {
  return model_->barrier();
}

bool BodyContact::depends_on_time() const {
  return model_->colliders.driven;
}

std::vector<double> BodyContact::breaks() const {
  return model_->colliders.breaks();
}

std::shared_ptr<const ForceMemory> BodyContact::remember(
    const StateView& state, const std::shared_ptr<const ForceMemory>& before) const {
  const BodyLedger* kept = ledger_of(before.get());
  auto next = std::make_shared<BodyLedger>();
  next->placed = model_->colliders.place(state);
  const auto closed = model_->each_touch(next->placed, kept, [&](const BodyContactPoint& at) {
    const std::size_t first = model_->points[at.near.point].collider, second = at.near.collider;
    next->touches.push_back({first, second, at.near.gap, at.surface, at.response.normal, at.response.force,
                             at.response.friction, at.response.sticks});
    if (model_->law.friction > 0.0)
      next->meetings.push_back({at.key, next->placed[first].to_local(at.surface),
                                next->placed[second].to_local(at.surface),
                                next->placed[second].rotation.transpose() * at.apart});
  });
  if (closed && !kept) refuse(*model_, *closed);
  sort_by_key(next->meetings);
  return next;
}

}  // namespace tendril::contact
