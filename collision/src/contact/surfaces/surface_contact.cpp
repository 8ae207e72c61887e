#include <tendril/contact/surface_contact.h>

#include <set>
#include <utility>

#include "contact/couple.h"
#include "surface_nodes.h"
#include "surface_touch.h"

namespace tendril::contact {
namespace {

/// Forces on vertices, by the patches that have them: a vertex of two patches stands twice.
class VertexForces {
 public:
  void add(const NearPoint& at, const Vec3& force) {
    if (at.patch != patch_) begin(*at.patch);
    for (std::size_t i = 0; i < 3; ++i) {
      if (at.at->share[i] == 0.0) continue;
      const std::uint32_t corner = at.triangle->corner[i];
      if (entry_[corner] == kNone) {
        entry_[corner] = vertices_.size();
        vertices_.push_back(at.patch->vertices[corner]);
        force_.emplace_back(Vec3::Zero());
      }
      force_[entry_[corner]] += at.at->share[i] * force;
    }
  }
  std::span<const std::uint32_t> vertices() const { return vertices_; }
  Points forces() const { return force_; }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  void begin(const Patch& patch) {
    patch_ = &patch;
    entry_.assign(patch.vertices.size(), kNone);
  }

  const Patch* patch_ = nullptr;
  std::vector<std::size_t> entry_;  ///< of the patch's vertices
  std::vector<std::uint32_t> vertices_;
  std::vector<Vec3> force_;
};

void add_forces(const SurfaceModel& model, const StateView& state, PosedSurface& surface,
                const SurfaceLedger* kept, const Loads& loads) {
  const std::size_t node = state.rods[model.points().rods().front()].first;
  if (!surface.sound()) return loads.refuse(node);
  VertexForces forces;
  const auto closed = each_meeting(model, surface, kept, [&](const SurfaceMeeting& meeting) {
    const Nearness& near = meeting.at.near;
    forces.add(meeting.at, meeting.response.force);
    if (const auto& body = model.colliders[near.collider].body)
      loads.bodies[*body].add_at(near.x, -meeting.response.force, near.placed->position);
  });
  if (closed) return loads.refuse(node);
  if (forces.vertices().empty()) return;
  if (!all_finite(forces.forces())) return loads.refuse(node);
  model.points().add_loads(
      state, model.points().points().pull_back(surface.pairs(), forces.vertices(), forces.forces()), loads);
}

/// The nodes of the rods that hold what is in the range of a solid, and the solid where it is free.
LocalCouplings acting_at(const SurfaceModel& model, const StateView& state) {
  const SurfaceLedger* kept = surface_ledger_of(state.memory);
  PosedSurface surface(model, state, kept);
  LocalCouplings result;
  if (!surface.sound()) return result;
  auto near = std::make_shared<SurfaceInRange>();
  near->holds.resize(model.points().rods().size(), false);
  std::set<std::pair<const Patch*, std::size_t>> seen;
  each_meeting(model, surface, kept, [&](const SurfaceMeeting& meeting) {
    const NearPoint& at = meeting.at;
    seen.emplace(at.patch, at.near.collider);
    near->points.push_back(
        {at.patch, at.triangle, at.near.collider, static_cast<std::uint32_t>(at.near.point)});
  });
  for (const auto& [patch, collider] : seen)
    for (const std::uint32_t span : patch->spans) near->holds[model.laid.spans[span].pair] = true;
  std::set<std::vector<std::size_t>> together;
  for (const auto& [patch, collider] : seen) {
    std::set<std::size_t> rods;
    for (const std::uint32_t span : patch->spans)
      rods.insert(model.points().rods()[model.laid.spans[span].pair]);
    std::vector<std::size_t> nodes;
    for (const std::size_t rod : rods) add_nodes(state.rods[rod], nodes);
    if (const auto& body = model.colliders[collider].body)
      for (const std::size_t turn : {0, 1}) nodes.push_back(state.p.size() + 2 * *body + turn);
    together.insert(std::move(nodes));
  }
  for (const std::vector<std::size_t>& nodes : together) couple(nodes, result);
  result.add = [&model, near](const StateView& beside, const Loads& loads) {
    const SurfaceLedger* at = surface_ledger_of(beside.memory);
    PosedSurface there(model, beside, at, *near);
    add_forces(model, beside, there, at, loads);
  };
  return result;
}

}  // namespace

SurfaceContact::SurfaceContact(ContactSurface surface, std::vector<Collider> colliders, const Law& law)
    : model_(std::make_unique<const SurfaceModel>(std::move(surface), std::move(colliders), law)) {}
SurfaceContact::~SurfaceContact() = default;

void SurfaceContact::add(const StateView& state, const Loads& loads) const {
  const SurfaceLedger* kept = surface_ledger_of(state.memory);
  PosedSurface surface(*model_, state, kept);
  add_forces(*model_, state, surface, kept, loads);
}

Couplings SurfaceContact::couplings(std::span<const NodeRange> rods) const {
  const std::size_t nodes = rods.empty() ? 0 : rods.back().first + rods.back().count;
  std::vector<std::size_t> all = nodes_of(model_->points(), rods);
  for (const std::size_t body : model_->colliders.bodies)
    for (const std::size_t turn : {0, 1}) all.push_back(nodes + 2 * body + turn);
  return Couplings::among(all).at_states(
      [model = model_.get()](const StateView& state) { return acting_at(*model, state); });
}

Couplings SurfaceContact::couplings_with_bodies(std::span<const NodeRange> rods, std::size_t bodies) const {
  model_->colliders.check_bodies(bodies);
  return couplings(rods);
}

void SurfaceContact::check(std::span<const NodeRange> rods) const {
  check_nodes(model_->points(), rods);
}

bool SurfaceContact::has_energy() const {
  return !model_->colliders.driven && conservative(model_->law);
}

double SurfaceContact::energy(const StateView& state) const {
  double sum = 0.0;
  const SurfaceLedger* kept = surface_ledger_of(state.memory);
  PosedSurface surface(*model_, state, kept);
  each_meeting(*model_, surface, kept, [&](const SurfaceMeeting& meeting) {
    sum += meeting.at.at->weight * model_->law.stiffness * potential(model_->law, meeting.at.near.gap).value;
  });
  return sum;
}

bool SurfaceContact::refuses() const {
  return model_->barrier();
}

bool SurfaceContact::depends_on_time() const {
  return model_->colliders.driven;
}

std::vector<double> SurfaceContact::breaks() const {
  return model_->colliders.breaks();
}

}  // namespace tendril::contact
