#include "posed_self.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/surfaces/surface_points.h"

namespace tendril::contact {

SelfModel::SelfModel(ContactSurface of, const Law& how, Meets what)
    : surface(checked(std::move(of))), law(checked(how)), which(what), mesh(surface) {
  std::vector<std::vector<std::vector<double>>> interpolation;
  for (const std::size_t rod : points().rods()) interpolation.push_back(points().curves().interpolation(rod));
  for (const UsedSpan& span : mesh.spans) gains.push_back(gain_of(span, interpolation[span.pair]));
}

SelfNodes SelfModel::nodes(const StateView& state) const {
  SelfNodes result;
  for (const std::size_t rod : points().rods()) {
    const std::vector<Vec3> arms = points().curves().arms(state, rod);
    const Points p = state.p.subspan(state.rods[rod].first, arms.size());
    result.p.insert(result.p.end(), p.begin(), p.end());
    result.arm.insert(result.arm.end(), arms.begin(), arms.end());
  }
  return result;
}

std::vector<double> SelfModel::coarse_motions(const SelfPose& before, const SelfNodes& then,
                                              const StateView& now) const {
  std::vector<RodMotion> rods;
  std::size_t first = 0;
  for (const std::size_t rod : points().rods()) {
    const std::vector<Vec3> arms = points().curves().arms(now, rod);
    const Points p = now.p.subspan(now.rods[rod].first, arms.size());
    RodMotion most;
    Vec3 last = Vec3::Zero();
    for (std::size_t i = 0; i < arms.size(); ++i) {
      const Vec3 way = p[i] - then.p[first + i];
      most.mass = std::max(most.mass, way.squaredNorm());
      if (i > 0) most.edge = std::max(most.edge, (way - last).squaredNorm());
      most.arm = std::max(most.arm, (arms[i] - then.arm[first + i]).squaredNorm());
      most.size = std::max({most.size, p[i].squaredNorm(), then.p[first + i].squaredNorm()});
      last = way;
    }
    rods.push_back({std::sqrt(most.mass), std::sqrt(most.edge), std::sqrt(most.arm), std::sqrt(most.size)});
    first += arms.size();
  }
  std::vector<double> result;
  for (std::size_t i = 0; i < mesh.spans.size(); ++i)
    result.push_back(motion(gains[i], mesh.spans[i], before.shapes[i], rods[mesh.spans[i].pair]));
  return result;
}

SelfPose SelfModel::pose(std::vector<CurvePair> pairs) const {
  SelfPose result{std::move(pairs), {}, {}};
  for (const UsedSpan& span : mesh.spans) {
    result.shapes.push_back(shape_of(span, result.pairs[span.pair]));
    result.going.push_back(going_with(span, result.pairs[span.pair]));
  }
  return result;
}

std::vector<double> SelfModel::motions(const SelfPose& before, std::span<const CurvePair> now) const {
  std::vector<double> result;
  result.reserve(mesh.spans.size());
  for (std::size_t i = 0; i < mesh.spans.size(); ++i) {
    const UsedSpan& span = mesh.spans[i];
    result.push_back(motion(span, before.shapes[i], before.pairs[span.pair], before.going[i], now[span.pair],
                            going_with(span, now[span.pair])));
    if (!(result.back() < kInfinite)) result.back() = measured(i, before.pairs, now);
  }
  return result;
}

/// Where a curve turns round within a span, bounds by its Bezier points say nothing, and an infinite one
/// would refuse a state that is sound: what is bound to it is placed twice.
double SelfModel::measured(std::size_t span, std::span<const CurvePair> before,
                           std::span<const CurvePair> now) const {
  const std::vector<std::uint32_t>& vertices = mesh.bound_to[span];
  std::vector<Vec3> was(vertices.size()), is(vertices.size());
  points().points().place(before, vertices, was);
  points().points().place(now, vertices, is);
  double most = 0.0;
  for (std::size_t i = 0; i < is.size(); ++i) most = std::max(most, (is[i] - was[i]).norm());
  return most * (1.0 + 1e-9);
}

double SelfModel::of_patch(std::uint32_t patch, std::span<const double> motions) const {
  double most = 0.0;
  for (const std::uint32_t span : mesh.patches[patch].spans) most = std::max(most, motions[span]);
  return most;
}

std::vector<Vec3> SelfModel::place(std::span<const CurvePair> pairs) const {
  std::vector<std::uint32_t> all(surface.rest.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<Vec3> result(all.size());
  points().points().place(pairs, all, result);
  return result;
}

PosedSelf::PosedSelf(const SelfModel& model, const StateView& state, const SelfLedger* kept, bool curves)
    : model_(model), state_(state), kept_(kept) {
  if (!curves && nothing_near()) return;
  pairs_ = model.points().pairs(state);
  sound_ = !pairs_.empty();
  if (!sound_) return;
  choose_list();
  if (!sound_) return;
  wake();
  place();
}

/// A first look, at masses and directors alone: in most evaluations of most scenes nothing is near, and
/// making the curves of all rods would cost more than their dynamics.
bool PosedSelf::nothing_near() {
  if (!kept_) return false;
  motions_ = model_.coarse_motions(kept_->pose, kept_->nodes, state_);
  for (std::size_t i = 0; i < motions_.size(); ++i)
    if (!(kept_->since_search[i] + motions_[i] <= kept_->list->margin[i])) return false;
  list_ = kept_->list;
  for (std::size_t g = 0; g < list_->groups.size(); ++g)
    if (!(kept_->slack[g] > moved(list_->groups[g]))) return false;
  return true;
}

/// That of the ledger while margins hold; else a new one for this state alone, wide enough for what has moved
/// since the ledger was kept: what has passed by on the way is as much a meeting as what is near now.
void PosedSelf::choose_list() {
  double most = 0.0;
  if (kept_) {
    motions_ = model_.motions(kept_->pose, pairs_);
    bool holds = true;
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      most = std::max(most, motions_[i]);
      holds = holds && kept_->since_search[i] + motions_[i] <= kept_->list->margin[i];
    }
    if (holds) {
      list_ = kept_->list;
      return;
    }
  }
  sound_ = most < kInfinite;
  if (!sound_) return;
  const std::vector<Vec3> at = model_.place(pairs_);
  sound_ = all_finite(at);
  if (!sound_) return;
  const bool wide = model_.barrier() && kept_;
  list_ = model_.search({}, at, wide ? motions_ : std::vector<double>(model_.mesh.spans.size(), 0.0));
  fresh_ = true;
}

double PosedSelf::moved(const SelfGroup& group) const {
  if (motions_.empty()) return 0.0;
  return model_.of_patch(group.p, motions_) + model_.of_patch(group.q, motions_);
}

/// A list made here has no slacks of the ledger to compare with.
void PosedSelf::wake() {
  for (std::uint32_t g = 0; g < list_->groups.size(); ++g)
    if (fresh_ || !(kept_->slack[g] > moved(list_->groups[g]))) awake_.push_back(g);
}

/// All vertices in one call: an update poses every span of every curve first.
void PosedSelf::place() {
  if (awake_.empty()) return;
  std::vector<char> wanted(list_->used.size(), 0);
  for (const std::uint32_t g : awake_) {
    const std::size_t begin = g == 0 ? 0 : list_->groups[g - 1].members;
    for (std::size_t i = begin; i < list_->groups[g].members; ++i) wanted[list_->members[i]] = 1;
  }
  slot_.resize(model_.surface.rest.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!wanted[i]) continue;
    slot_[list_->used[i]] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(list_->used[i]);
  }
  now_.resize(vertices_.size());
  model_.points().points().place(pairs_, vertices_, now_);
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
    std::vector<Vec3> found(missing.size());
    if (!missing.empty()) model_.points().points().place(kept_->pose.pairs, missing, found);
    for (std::size_t i = 0; i < missing.size(); ++i) before_[slot_[missing[i]]] = found[i];
  }
  return before_[slot_[vertex]];
}

const Vec3& PosedSelf::velocity(std::uint32_t vertex) {
  if (velocity_.empty()) {
    velocity_.assign(vertices_.size(), Vec3::Zero());
    const std::vector<CurvePair> rates = model_.points().rates(state_);
    if (!rates.empty()) model_.points().points().velocities(pairs_, rates, vertices_, velocity_);
  }
  return velocity_[slot_[vertex]];
}

}  // namespace tendril::contact
