#include <tendril/contact/rod_rod_contact.h>

#include <utility>

#include "contact/couple.h"
#include "pair_model.h"

namespace tendril::contact {
namespace {

const PairLedger* ledger_of(const ForceMemory* memory) {
  return static_cast<const PairLedger*>(memory);
}

/// The two nodes that a point hangs between, and by how much on each.
struct Shares {
  std::size_t node;
  double share[2];
};

Shares shares_of(const PairModel& model, const StateView& state, std::size_t point) {
  const LinePoint& at = model.lines.points[point];
  return {model.lines.node_of(state, model.lines.edges[at.edge]), {1.0 - at.fraction, at.fraction}};
}

void add_derivatives(const PairModel& model, const StateView& state, const PairTouch& touch,
                     LoadDerivatives& to) {
  const Shares side[2] = {shares_of(model, state, touch.at.first), shares_of(model, state, touch.at.second)};
  const Mat3 by_place = by_position(touch.push, touch.normal, bend_of(touch.at));
  const Mat3 by_rate = by_velocity(touch.push, touch.normal);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
          const double share = (a == b ? 1.0 : -1.0) * side[a].share[i] * side[b].share[j];
          to.add_by_position(side[a].node + i, side[b].node + j, share * by_place);
          to.add_by_velocity(side[a].node + i, side[b].node + j, share * by_rate);
        }
}

/// The nodes between which points hang that are in the range of each other.
LocalCouplings acting_at(const PairModel& model, const StateView& state) {
  LocalCouplings result;
  Couplings::Pair last{~std::size_t{0}, 0};
  each_touch(model, state, model.lines.positions(state), ledger_of(state.memory),
             [&](const PairTouch& touch) {
               const std::size_t e = shares_of(model, state, touch.at.first).node;
               const std::size_t f = shares_of(model, state, touch.at.second).node;
               // Points of two edges follow each other.
               const Couplings::Pair here(e, f);
               if (std::exchange(last, here) == here) return;
               couple({e, e + 1, f, f + 1}, result);
             });
  return result;
}

}  // namespace

RodRodContact::RodRodContact(std::vector<ContactRod> rods, const std::vector<RodJoint>& joints,
                             const Law& law)
    : model_(std::make_unique<const PairModel>(std::move(rods), joints, law)) {}
RodRodContact::~RodRodContact() = default;

void RodRodContact::add(const StateView& state, const Loads& loads) const {
  const auto put = [&](std::size_t point, const Vec3& force, const Vec3& torque) {
    const Shares at = shares_of(*model_, state, point);
    for (std::size_t i = 0; i < 2; ++i) {
      loads.force[at.node + i] += at.share[i] * force;
      if (model_->law.friction > 0.0) loads.torque[at.node + i] += at.share[i] * torque;
    }
  };
  const auto closed = each_touch(
      *model_, state, model_->lines.positions(state), ledger_of(state.memory), [&](const PairTouch& touch) {
        const Vec3 turn = touch.friction.cross(touch.normal), whole = touch.at.apart.norm() * turn;
        const Vec3 first = touch.arm * turn;
        put(touch.at.first, touch.force, first);
        put(touch.at.second, -touch.force, whole - first);
      });
  if (closed) loads.refuse(shares_of(*model_, state, closed->first).node);
}

Couplings RodRodContact::couplings(std::span<const NodeRange> rods) const {
  std::vector<std::size_t> nodes;
  for (const ContactRod& rod : model_->lines.rods)
    for (std::size_t i = 0; i < rods[rod.rod].count; ++i) nodes.push_back(rods[rod.rod].first + i);
  Couplings all = Couplings::among(nodes).at_states(
      [model = model_.get()](const StateView& state) { return acting_at(*model, state); });
  if (model_->law.friction > 0.0) return all;
  return std::move(all).with([model = model_.get()](const StateView& state, LoadDerivatives& to) {
    each_touch(*model, state, model->lines.positions(state), ledger_of(state.memory),
               [&](const PairTouch& touch) { add_derivatives(*model, state, touch, to); });
  });
}

void RodRodContact::check(std::span<const NodeRange> rods) const {
  model_->lines.check(rods);
}

bool RodRodContact::has_energy() const {
  return conservative(model_->law);
}

double RodRodContact::energy(const StateView& state) const {
  double sum = 0.0;
  each_touch(*model_, state, model_->lines.positions(state), ledger_of(state.memory),
             [&](const PairTouch& touch) {
               sum += model_->weight(touch.at) * potential(model_->law, touch.at.gap).value;
             });
  return model_->law.stiffness * sum;
}

bool RodRodContact::refuses() const {
  return model_->barrier();
}

bool RodRodContact::twists() const {
  return model_->law.friction > 0.0;
}

}  // namespace tendril::contact
