#include "surface_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tendril::contact {
namespace {

/// By how much sides of triangles may lengthen before points stand too far apart.
constexpr double kWiden = 2.0;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Sides h at rest with (kWiden h)^2 / (6 (R + skin)) <= range / 32: what comes half the range near has some
/// dozen points within it, so that the sum over them hardly feels where they are.
double apart_for(const Solids& solids, double skin, double range) {
  double least = kInfinite;
  for (const Collider& collider : solids.all)
    least = std::min(least, std::sqrt(0.1875 * (collider.shape->outward_radius() + skin) * range) / kWiden);
  return least;
}

/// A box about balls.
struct Hull {
  Vec3 low = Vec3::Constant(kInfinite), high = Vec3::Constant(-kInfinite);

  void take(const Vec3& x, double radius) {
    low = low.cwiseMin(x - Vec3::Constant(radius));
    high = high.cwiseMax(x + Vec3::Constant(radius));
  }
  void take(const Hull& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  double radius() const { return 0.5 * (high - low).norm(); }
};

}  // namespace

SurfaceModel::SurfaceModel(ContactSurface of, std::vector<Collider> with, const Law& how)
    : surface(checked(std::move(of))),
      law(checked(how)),
      colliders(std::move(with), surface.skin + law.range),
      laid(surface, apart_for(colliders, surface.skin, law.range)) {
  for (const std::size_t rod : points().rods()) gain.push_back(points().curves().gain(rod));
  for (std::size_t c = 0; c < colliders.size(); ++c) {
    round.push_back(kWiden * kWiden / (6.0 * (colliders[c].shape->outward_radius() + surface.skin)));
    double most = 0.0;
    for (const SurfacePoint& point : laid.points) most = std::max(most, margin(point, c));
    widest.push_back(most);
  }
}

std::vector<Vec3> SurfaceModel::positions(const StateView& state) const {
  std::vector<Vec3> result;
  for (const std::size_t rod : points().rods()) {
    const NodeRange& range = state.rods[rod];
    const Points p = state.p.subspan(range.first, range.count);
    result.insert(result.end(), p.begin(), p.end());
  }
  return result;
}

PosedSurface::PosedSurface(const SurfaceModel& model, const StateView& state, const SurfaceLedger* kept,
                           Colliders which)
    : model_(model), state_(state), kept_(kept), placed_(model.colliders.place(state)) {
  for (std::size_t c = 0; c < model.colliders.size(); ++c)
    if (which == Colliders::all || !still_far(c)) awake_.push_back(c);
  if (awake_.empty()) return;
  pairs_ = model.points().pairs(state);
  sound_ = !pairs_.empty();
  if (!sound_) awake_.clear();
}

/// Curves that hold nothing in range may be anywhere.
PosedSurface::PosedSurface(const SurfaceModel& model, const StateView& state, const SurfaceLedger* kept,
                           const SurfaceInRange& near)
    : model_(model), state_(state), kept_(kept), near_(&near), placed_(model.colliders.place(state)) {
  pairs_ = model.points().pairs(state, near.holds);
  sound_ = !pairs_.empty();
}

/// In the frame of the solid a mass moved by at most some way, and control points by at most the gain times
/// it, since interpolation carries every motion of the frame along; so what the hulls about them hold moved
/// no farther.
bool PosedSurface::still_far(std::size_t collider) const {
  if (!kept_ || !(kept_->slack[collider] > 0.0)) return false;
  const Placement &now = placed_[collider], &before = kept_->solids[collider];
  const bool moves = model_.colliders[collider].moves();
  const double limit = kept_->slack[collider];
  std::size_t at = 0;
  for (std::size_t k = 0; k < model_.gain.size(); ++k) {
    const NodeRange& range = state_.rods[model_.points().rods()[k]];
    const double most = limit / model_.gain[k], square = most * most;
    for (std::size_t i = range.first; i < range.first + range.count; ++i, ++at) {
      const Vec3 way = moves ? Vec3(now.to_local(state_.p[i]) - before.to_local(kept_->p[at]))
                             : Vec3(state_.p[i] - kept_->p[at]);
      if (!(way.squaredNorm() < square)) return false;
    }
  }
  return true;
}

/// The second look, where the first says nothing: with the frames, some 0.1 us a span, before a vertex is
/// deformed. Rates of turn are bounded by the shapes that were measured when the ledger was kept.
std::vector<double> PosedSurface::motions(std::size_t c) const {
  std::vector<double> result;
  if (!kept_) return result;
  for (std::size_t i = 0; i < model_.laid.spans.size(); ++i) {
    const UsedSpan& span = model_.laid.spans[i];
    result.push_back(motion(span, kept_->shapes[i], {kept_->pairs[span.pair], kept_->solids[c]},
                            {pairs_[span.pair], placed_[c]}));
  }
  return result;
}

/// A blended vertex moves as a mean of the points it is made of.
double PosedSurface::of_patch(const Patch& patch, const std::vector<double>& motions) {
  double most = 0.0;
  for (const std::uint32_t span : patch.spans) most = std::max(most, motions[span]);
  return most;
}

bool PosedSurface::far(const Patch& patch, std::size_t c, const std::vector<double>& motions) const {
  return kept_ &&
         of_patch(patch, motions) < kept_->patch_slack[index_of(patch) * model_.colliders.size() + c];
}

/// A point is within `reach` of its curve, and that in the hull of its control points. Coarse beside a wide
/// leaf, but it holds whatever the frames do, so that still_far() need not know them: an evaluation where
/// nothing is near makes no curves at all.
double PosedSurface::apart(std::size_t collider) const {
  const Placement& placed = placed_[collider];
  std::vector<Hull> hulls;
  for (const UsedSpan& span : model_.laid.spans) {
    Hull hull;
    for (const Vec3& x : pairs_[span.pair].primary().control_points().subspan(span.first, span.count))
      hull.take(placed.to_local(x), span.reach * (1.0 + 1e-9));
    hulls.push_back(hull);
  }
  double least = kInfinite;
  for (const Patch& patch : model_.laid.patches) {
    Hull all;
    for (const std::uint32_t span : patch.spans) all.take(hulls[span]);
    least = std::min(least, model_.colliders[collider].shape->distance(all.centre()) - all.radius());
  }
  return least - reach_of(collider) - model_.law.range;
}

double PosedSurface::apart(const Patch& patch, std::size_t c) {
  const std::vector<Vec3>& at = vertices(patch);
  double least = kInfinite;
  for (const LaidTriangle& triangle : patch.triangles) {
    const auto [centre, radius] = about(triangle, at);
    least = std::min(least, model_.colliders[c].shape->distance(placed_[c].to_local(centre)) - radius);
  }
  return least - reach_of(c) - model_.law.range;
}

AboutTriangle about(const LaidTriangle& triangle, const std::vector<Vec3>& at) {
  const auto& [i, j, k] = triangle.corner;
  const Vec3 centre = (at[i] + at[j] + at[k]) / 3.0;
  const auto square = [&](std::uint32_t corner) { return (at[corner] - centre).squaredNorm(); };
  return {centre, std::sqrt(std::max({square(i), square(j), square(k)}))};
}

PosedSurface::Found& PosedSurface::found(const Patch& patch) {
  const auto [at, added] = found_.try_emplace(index_of(patch));
  if (added) {
    at->second.now.resize(patch.vertices.size());
    model_.points().points().place(pairs_, patch.vertices, at->second.now);
    deformed_ += static_cast<long>(patch.vertices.size());
  }
  return at->second;
}

std::vector<double> PosedSurface::ways(const Patch& patch, std::size_t collider) {
  std::vector<double> result(patch.vertices.size(), 0.0);
  if (!kept_ || !model_.barrier()) return result;
  const std::vector<Vec3>&now = vertices(patch), &before = vertices_before(patch);
  const Placement &placed = placed_[collider], &was = kept_->solids[collider];
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = (placed.to_local(now[i]) - was.to_local(before[i])).norm();
  return result;
}

NearPoint PosedSurface::near_point(const OfTriangle& of, std::uint32_t point) const {
  const SurfacePoint& laid = model_.laid.points[point];
  const auto& [i, j, k] = of.triangle->corner;
  const std::size_t c = of.collider;
  const Vec3 x = mix(laid.share, of.vertices[i], of.vertices[j], of.vertices[k]);
  const Vec3 local = placed_[c].to_local(x);
  const double gap =
      model_.colliders[c].shape->distance(local) - model_.surface.skin - model_.margin(laid, c);
  return {
      of.patch, of.triangle, &laid, of.moved, {point, c, x, local, gap, &placed_[c], model_.surface.skin}};
}

const std::vector<Vec3>& PosedSurface::vertices_before(const Patch& patch) {
  const auto known = kept_->vertices.find(index_of(patch));
  if (known != kept_->vertices.end()) return known->second;
  std::vector<Vec3>& before = found(patch).before;
  if (before.empty()) {
    before.resize(patch.vertices.size());
    model_.points().points().place(kept_->pairs, patch.vertices, before);
  }
  return before;
}

const std::vector<Vec3>& PosedSurface::velocities(const Patch& patch) {
  std::vector<Vec3>& velocity = found(patch).velocity;
  if (!velocity.empty()) return velocity;
  if (rates_.empty())
    rates_ = near_ ? model_.points().rates(state_, near_->holds) : model_.points().rates(state_);
  velocity.resize(patch.vertices.size(), Vec3::Zero());
  if (!rates_.empty()) model_.points().points().velocities(pairs_, rates_, patch.vertices, velocity);
  return velocity;
}

std::map<std::size_t, std::vector<Vec3>> PosedSurface::take_vertices() {
  std::map<std::size_t, std::vector<Vec3>> result;
  for (auto& [patch, one] : found_) result.emplace(patch, std::move(one.now));
  return result;
}

}  // namespace tendril::contact
