#include "posed_self.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/by_key.h"

namespace tendril::contact {
namespace {

/// Curves of masses farther than this from the origin could overflow.
constexpr double kMost = 1e150;

bool fits(Points points) {
  return std::all_of(points.begin(), points.end(),
                     [](const Vec3& x) { return x.cwiseAbs().maxCoeff() < kMost; });
}

}  // namespace

PosedSelf::PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept)
    : model_(model), state_(state), kept_(kept), scratch_(model.take_scratch()), arms_(model.rods()) {
  bounded_.resize(arms_.size(), By::rod);
  for (std::size_t rod = 0; rod < arms_.size(); ++rod) sound_ = take_arms(rod) && sound_;
  if (!sound_) return;
  if (kept_ && kept_->list->holds_at(state.time)) {
    share_ = kept_->list->share(state.time);
    look();
  } else {
    search();
  }
  if (sound_) place();
}

PosedSelf::PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept,
                     const SelfInRange& near)
    : model_(model), state_(state), kept_(kept), scratch_(model.take_scratch()), arms_(model.rods()) {
  concerned_ = near.rods;
  vertices_ = near.vertices;
  for (const std::uint32_t rod : concerned_) sound_ = take_arms(rod) && sound_;
  if (sound_) place_vertices();
}

bool PosedSelf::take_arms(std::size_t rod) {
  arms_[rod] = model_.points().curves().arms(state_, model_.points().rods()[rod]);
  return fits(masses(rod)) && fits(arms_[rod]);
}

Points PosedSelf::masses(std::size_t rod) const {
  return state_.p.subspan(state_.rods[model_.points().rods()[rod]].first, arms_[rod].size());
}

const CurvePair& PosedSelf::curve(std::size_t rod) {
  if (made_.empty()) made_.resize(arms_.size(), 0);
  if (!std::exchange(made_[rod], 1)) scratch_->now[rod] = model_.curve(rod, masses(rod), arms_[rod]);
  return scratch_->now[rod];
}

const CurvePair& PosedSelf::kept_curve(std::size_t rod) {
  return scratch_->before[rod] = model_.curve(rod, kept_->p[rod], kept_->arm[rod]);
}

std::span<const double> PosedSelf::motions(std::size_t rod, By by) {
  if (motions_.empty()) motions_.resize(model_.mesh.spans.size(), 0.0);
  if (bounded_[rod] >= by) return motions_;
  bounded_[rod] = by;
  const RodWay& way = kept_->list->ways[rod];
  if (by == By::masses)
    model_.local_motions(rod, way, share_, masses(rod), arms_[rod], motions_);
  else
    model_.motions(rod, way, share_, curve(rod), motions_);
  return motions_;
}

bool PosedSelf::stays(std::size_t rod) {
  const SelfList& list = *kept_->list;
  coarse_.push_back(model_.coarse_motion(rod, list.ways[rod], share_, masses(rod), arms_[rod]));
  if (coarse_.back() <= list.rod_room[rod]) return true;
  const std::span<const double> motions = this->motions(rod, By::masses);
  return std::all_of(model_.spans_of[rod].begin(), model_.spans_of[rod].end(),
                     [&](std::uint32_t span) { return motions[span] <= list.room[span]; });
}

/// Masses first: in most evaluations most rods moved too little for anything to be near, and making their
/// curves would cost more than their dynamics.
void PosedSelf::look() {
  std::vector<std::uint32_t> moving;
  coarse_.reserve(arms_.size());
  for (std::uint32_t rod = 0; rod < arms_.size(); ++rod)
    if (!stays(rod)) moving.push_back(rod);
  for (const std::uint32_t rod : moving) {
    if (within_margins(rod)) continue;
    const std::span<const double> motions = this->motions(rod, By::curves);
    for (const std::uint32_t span : model_.spans_of[rod]) sound_ = sound_ && motions[span] < kInfinite;
    if (!sound_ || !within_margins(rod)) return search();
  }
  awake_ = kept_->awake;
  if (!moving.empty()) wake(moving);
}

bool PosedSelf::within_margins(std::size_t rod) const {
  return std::all_of(model_.spans_of[rod].begin(), model_.spans_of[rod].end(),
                     [&](std::uint32_t span) { return motions_[span] <= kept_->list->margin[span]; });
}

/// What no moving rod has a part in has no more than both rooms. By masses first, then by curves. What was
/// awake at the ledger's state stays so: it may have been near on the way from there.
void PosedSelf::wake(const std::vector<std::uint32_t>& moving) {
  for (std::size_t rod = 0; rod < bounded_.size(); ++rod)
    if (bounded_[rod] == By::rod)
      for (const std::uint32_t span : model_.spans_of[rod]) motions_[span] = coarse_[rod];
  const auto asleep = [&](std::uint32_t group) {
    const SelfGroup& of = kept_->list->groups[group];
    return of.slack_at(share_) > model_.of_patch(of.p, motions_) + model_.of_patch(of.q, motions_);
  };
  for (const std::uint32_t rod : moving)
    for (const std::uint32_t group : kept_->list->with(rod))
      if (!asleep(group)) woken_.push_back(group);
  if (woken_.empty()) return;
  sort_once(woken_);
  for (const std::uint32_t rod : rods_of(woken_)) motions(rod, By::curves);
  woken_.erase(std::remove_if(woken_.begin(), woken_.end(), asleep), woken_.end());
  awake_.insert(awake_.end(), woken_.begin(), woken_.end());
  sort_once(awake_);
}

/// For this state alone, and wide enough for what has moved since the ledger was kept: what has passed by on
/// the way is as much a meeting as what is near now.
void PosedSelf::search() {
  auto list = std::make_shared<SelfList>();
  list->margin.assign(model_.mesh.spans.size(), 0.0);
  for (std::size_t rod = 0; rod < arms_.size(); ++rod) curve(rod);
  for (std::size_t rod = 0; rod < arms_.size() && kept_ && model_.barrier(); ++rod) {
    const RodWay way = model_.stay(rod, kept_curve(rod), kept_->p[rod], kept_->arm[rod]);
    model_.motions(rod, way, 0.0, curve(rod), list->margin);
    for (const std::uint32_t span : model_.spans_of[rod]) sound_ = sound_ && list->margin[span] < kInfinite;
  }
  if (!sound_) return;
  const std::vector<Vec3> at = model_.place(pairs());
  sound_ = all_finite(at);
  if (!sound_) return;
  model_.search(at, at, kept_ ? kept_->list.get() : nullptr, *list);
  own_ = std::move(list);
  for (std::uint32_t g = 0; g < own_->groups.size(); ++g) awake_.push_back(g);
}

std::vector<std::uint32_t> PosedSelf::rods_of(const std::vector<std::uint32_t>& groups) const {
  std::vector<std::uint32_t> rods;
  for (const std::uint32_t g : groups)
    for (const std::uint32_t patch : {list().groups[g].p, list().groups[g].q})
      rods.insert(rods.end(), model_.rods_of[patch].begin(), model_.rods_of[patch].end());
  sort_once(rods);
  return rods;
}

/// All vertices in one call, of the rods concerned alone.
void PosedSelf::place() {
  if (awake_.empty()) return;
  concerned_ = rods_of(awake_);
  std::vector<char> seen(model_.surface.rest.size(), 0);
  for (const std::uint32_t g : awake_)
    for (const std::uint32_t patch : {list().groups[g].p, list().groups[g].q})
      for (const std::uint32_t v : model_.mesh.patches[patch].corners)
        if (!std::exchange(seen[v], 1)) vertices_.push_back(v);
  std::sort(vertices_.begin(), vertices_.end());
  place_vertices();
}

void PosedSelf::place_vertices() {
  for (const std::uint32_t rod : concerned_) curve(rod);
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    scratch_->slot[vertices_[i]] = static_cast<std::uint32_t>(i);
  now_.resize(vertices_.size());
  model_.points().points().place(pairs(), vertices_, now_);
}

double PosedSelf::moved(const SelfGroup& group) {
  if (!kept_) return 0.0;
  const auto of_patch = [&](std::uint32_t patch) {
    double most = 0.0;
    for (const std::uint32_t v : model_.mesh.patches[patch].corners)
      most = std::max(most, (at(v) - before(v)).squaredNorm());
    return std::sqrt(most);
  };
  return (of_patch(group.p) + of_patch(group.q)) * (1.0 + 1e-9);
}

const NearGroup* PosedSelf::known(const SelfGroup& group) const {
  return kept_ ? find_key(kept_->near, group.key()) : nullptr;
}

/// From the ledger where it has them all.
const Vec3& PosedSelf::before(std::uint32_t vertex) {
  if (before_.empty()) {
    before_.resize(vertices_.size());
    std::vector<std::uint32_t> missing;
    std::size_t k = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      while (k < kept_->known.size() && kept_->known[k] < vertices_[i]) ++k;
      if (k < kept_->known.size() && kept_->known[k] == vertices_[i])
        before_[i] = kept_->at[k];
      else
        missing.push_back(vertices_[i]);
    }
    if (!missing.empty()) {
      for (const std::uint32_t rod : concerned_) kept_curve(rod);
      std::vector<Vec3> found(missing.size());
      model_.points().points().place(scratch_->before, missing, found);
      for (std::size_t i = 0; i < missing.size(); ++i) before_[slot(missing[i])] = found[i];
    }
  }
  return before_[slot(vertex)];
}

const Vec3& PosedSelf::velocity(std::uint32_t vertex) {
  if (velocity_.empty()) {
    velocity_.assign(vertices_.size(), Vec3::Zero());
    bool fit = true;
    for (const std::uint32_t rod : concerned_) {
      const std::size_t index = model_.points().rods()[rod], first = state_.rods[index].first;
      const std::size_t count = arms_[rod].size();
      fit = fit && fits(state_.v.subspan(first, count)) && fits(state_.turn.subspan(first, count));
      if (fit) scratch_->rates[rod] = model_.points().curves().rates(state_, index);
    }
    if (fit) model_.points().points().velocities(pairs(), scratch_->rates, vertices_, velocity_);
  }
  return velocity_[slot(vertex)];
}

}  // namespace tendril::contact
