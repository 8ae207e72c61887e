#include <tendril/base/error.h>

#include <string>
#include <utility>

#include "contact/couple.h"
#include "contact/surfaces/surface_nodes.h"
#include "posed_self.h"

namespace tendril::contact {

SurfaceSelfContact::SurfaceSelfContact(ContactSurface surface, const Law& law, Meets which)
    : model_(std::make_unique<const SelfModel>(std::move(surface), law, which)) {}
SurfaceSelfContact::~SurfaceSelfContact() = default;

namespace {

std::size_t first_node(const SelfModel& model, const StateView& state) {
  return state.rods[model.points().rods().front()].first;
}

void add_forces(const SelfModel& model, const StateView& state, const PosedSelf& surface,
                const SelfMeetings& meetings, const Loads& loads) {
  const std::size_t node = first_node(model, state);
  if (meetings.closed) return loads.refuse(node);
  if (meetings.all.empty()) return;
  std::vector<Vec3> all(surface.vertices().size(), Vec3::Zero());
  std::vector<char> met(all.size(), 0);
  for (const SelfResponse& meeting : meetings.all)
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t slot = surface.slot(meeting.at.vertex[i]);
      all[slot] += meeting.at.weight[i] * meeting.force + meeting.by_angle[i];
      met[slot] = 1;
    }
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3> forces;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!met[i]) continue;
    vertices.push_back(surface.vertices()[i]);
    forces.push_back(all[i]);
  }
  if (!all_finite(forces)) return loads.refuse(node);
  model.points().add_loads(state, model.points().points().pull_back(surface.pairs(), vertices, forces),
                           loads);
}

/// What acts at a state: the nodes of rods whose parts meet there couple, and beside it only those parts are
/// looked at.
LocalCouplings acting_at(const SelfModel& model, const StateView& state) {
  const SelfLedger* kept = self_ledger_of(state.memory);
  PosedSelf surface(model, state, kept);
  if (!surface.sound() || surface.awake().empty()) return {};
  auto near = std::make_shared<const SelfInRange>(in_range(model, meetings_of(model, surface, kept).pairs));
  LocalCouplings result;
  for (const std::vector<std::uint32_t>& rods : near->together) {
    std::vector<std::size_t> nodes;
    for (const std::uint32_t rod : rods) add_nodes(state.rods[model.points().rods()[rod]], nodes);
    couple(nodes, result);
  }
  result.add = [&model, near](const StateView& beside, const Loads& loads) {
    const SelfLedger* at = self_ledger_of(beside.memory);
    PosedSelf there(model, beside, at, *near);
    if (!there.sound()) return loads.refuse(first_node(model, beside));
    add_forces(model, beside, there, meetings_of(model, there, at, near->pairs), loads);
  };
  return result;
}

}  // namespace

void SurfaceSelfContact::add(const StateView& state, const Loads& loads) const {
  const SelfModel& model = *model_;
  const SelfLedger* kept = self_ledger_of(state.memory);
  PosedSelf surface(model, state, kept);
  if (!surface.sound()) return loads.refuse(first_node(model, state));
  if (surface.awake().empty()) return;
  add_forces(model, state, surface, meetings_of(model, surface, kept), loads);
}

Couplings SurfaceSelfContact::couplings(std::span<const NodeRange> rods) const {
  return Couplings::among(nodes_of(model_->points(), rods))
      .at_states([model = model_.get()](const StateView& state) { return acting_at(*model, state); });
}

void SurfaceSelfContact::check(std::span<const NodeRange> rods) const {
  check_nodes(model_->points(), rods);
}

bool SurfaceSelfContact::has_energy() const {
  return conservative(model_->law);
}

double SurfaceSelfContact::energy(const StateView& state) const {
  const SelfLedger* kept = self_ledger_of(state.memory);
  PosedSelf surface(*model_, state, kept);
  double sum = 0.0;
  if (!surface.sound() || surface.awake().empty()) return sum;
  for (const SelfResponse& meeting : meetings_of(*model_, surface, kept).all) sum += meeting.energy;
  return sum;
}

bool SurfaceSelfContact::refuses() const {
  return model_->barrier();
}

}  // namespace tendril::contact
