#include "self_model.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "contact/surfaces/surface_points.h"

namespace tendril::contact {

SelfModel::SelfModel(ContactSurface of, const Law& how, Meets what)
    : surface(checked(std::move(of))),
      law(checked(how)),
      which(what),
      mesh(surface),
      all_(surface.rest.size()) {
  std::iota(all_.begin(), all_.end(), 0U);
  spans_of.resize(rods());
  patches_of.resize(rods());
  rod_gain.resize(rods(), {0.0, 0.0});
  rod_reach.resize(rods(), 0.0);
  std::vector<std::vector<std::vector<double>>> interpolation;
  for (const std::size_t rod : points().rods()) interpolation.push_back(points().curves().interpolation(rod));
  for (std::uint32_t i = 0; i < mesh.spans.size(); ++i) {
    const UsedSpan& span = mesh.spans[i];
    spans_of[span.pair].push_back(i);
    const SpanGain own = gain_of(span, interpolation[span.pair]);
    span_gain.push_back(local_gain_of(span, interpolation[span.pair]));
    SpanGain& most = rod_gain[span.pair];
    most = {std::max(most.at, own.at), std::max(most.rate, own.rate)};
    rod_reach[span.pair] = std::max(rod_reach[span.pair], span.reach);
  }
  patch_size.resize(mesh.spans.size(), 0.0);
  for (const SelfPatch& patch : mesh.patches) {
    Vec3 low = surface.rest[patch.corners[0]], high = low;
    for (const std::uint32_t v : patch.corners) {
      low = low.cwiseMin(surface.rest[v]);
      high = high.cwiseMax(surface.rest[v]);
    }
    for (const std::uint32_t span : patch.spans)
      patch_size[span] = std::max(patch_size[span], (high - low).norm());
  }
  for (std::uint32_t p = 0; p < mesh.patches.size(); ++p) {
    std::vector<std::uint32_t> of_patch;
    for (const std::uint32_t span : mesh.patches[p].spans) of_patch.push_back(mesh.spans[span].pair);
    sort_once(of_patch);
    for (const std::uint32_t rod : of_patch) patches_of[rod].push_back(p);
    rods_of.push_back(std::move(of_patch));
  }
}

/// Curves of two hundred rods are a thousand small pieces of memory, of which an evaluation wants a few:
/// what one leaves behind serves the next, as knots never change and what is stale is not looked at.
std::unique_ptr<SelfScratch> SelfModel::take_scratch() const {
  {
    const std::lock_guard guard(lock_);
    if (!scratch_.empty()) {
      std::unique_ptr<SelfScratch> result = std::move(scratch_.back());
      scratch_.pop_back();
      return result;
    }
  }
  auto result = std::make_unique<SelfScratch>();
  result->slot.resize(surface.rest.size());
  for (const std::size_t rod : points().rods()) {
    const KnotVector& knots = points().curves().knots(rod);
    const std::vector<Vec3> none(static_cast<std::size_t>(knots.control_points()), Vec3::Zero());
    result->now.emplace_back(knots, none, none);
  }
  result->before = result->rates = result->now;
  return result;
}

void SelfModel::give_back(std::unique_ptr<SelfScratch> scratch) const {
  const std::lock_guard guard(lock_);
  scratch_.push_back(std::move(scratch));
}

/// As RodCurves::pair() has it, to the last bit.
CurvePair SelfModel::curve(std::size_t rod, Points p, Points arm) const {
  std::vector<Vec3> q(arm.begin(), arm.end());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = p[i] + q[i];
  return points().curves().through(points().rods()[rod], p, q);
}

RodWay SelfModel::way(std::size_t rod, const CurvePair& from, const CurvePair& to, RodWay way) const {
  way.worst = {kInfinite, kInfinite, 0.0};
  way.bow = 0.0;
  way.spans.reserve(spans_of[rod].size());
  for (const std::uint32_t i : spans_of[rod]) {
    way.spans.push_back(way_of(mesh.spans[i], from, to));
    const SpanShape& shape = way.spans.back().shape;
    way.worst = {std::min(way.worst.least_speed, shape.least_speed),
                 std::min(way.worst.least_across, shape.least_across),
                 std::max(way.worst.most_offset, shape.most_offset)};
    way.bow = std::max(way.bow, way.spans.back().bow);
  }
  return way;
}

RodWay SelfModel::stay(std::size_t rod, const CurvePair& there, Points p, Points arm) const {
  const std::vector<Vec3> none(p.size(), Vec3::Zero());
  return way(rod, there, there, {{p.begin(), p.end()}, {arm.begin(), arm.end()}, none, none, {}, {}, 0.0});
}

namespace {

/// How far masses are from their way.
/// \param each  takes the squares for a mass, the edge that ends there and its arm
template <class Each>
RodMotion motion_of(const RodWay& from, double share, Points p, Points arm, Each&& each) {
  RodMotion most;
  Vec3 last = Vec3::Zero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 way = p[i] - from.p[i] - share * from.p_change[i];
    const double mass = way.squaredNorm(), edge = i > 0 ? (way - last).squaredNorm() : 0.0;
    const double turn = (arm[i] - from.arm[i] - share * from.arm_change[i]).squaredNorm();
    most.mass = std::max(most.mass, mass);
    most.edge = std::max(most.edge, edge);
    most.arm = std::max(most.arm, turn);
    most.size = std::max({most.size, p[i].squaredNorm(), from.p[i].squaredNorm()});
    each(i, mass, edge, turn);
    last = way;
  }
  return {std::sqrt(most.mass), std::sqrt(most.edge), std::sqrt(most.arm), std::sqrt(most.size)};
}

}  // namespace

/// Each number that motion() takes only makes it larger, so that the worst of all spans bounds each of them.
double SelfModel::coarse_motion(std::size_t rod, const RodWay& way, double share, Points p,
                                Points arm) const {
  const RodMotion most = motion_of(way, share, p, arm, [](std::size_t, double, double, double) {});
  return motion(rod_gain[rod], rod_reach[rod], way.worst, most) + strays(way.bow, share);
}

/// A clamped leaf swings at its tip and hardly at its foot: what is near there sleeps on.
void SelfModel::local_motions(std::size_t rod, const RodWay& way, double share, Points p, Points arm,
                              std::span<double> motions) const {
  MassMotions masses{std::vector<double>(p.size()), std::vector<double>(p.size(), 0.0),
                     std::vector<double>(p.size())};
  const auto note = [&](std::size_t i, double mass, double edge, double turn) {
    masses.mass[i] = std::sqrt(mass);
    if (i > 0) masses.edge[i - 1] = std::sqrt(edge);
    masses.arm[i] = std::sqrt(turn);
  };
  const RodMotion most = motion_of(way, share, p, arm, note);
  for (std::size_t k = 0; k < spans_of[rod].size(); ++k) {
    const std::uint32_t i = spans_of[rod][k];
    motions[i] = motion(span_gain[i], mesh.spans[i], way.spans[k].shape, most, masses) +
                 strays(way.spans[k].bow, share);
  }
}

void SelfModel::motions(std::size_t rod, const RodWay& way, double share, const CurvePair& now,
                        std::span<double> motions) const {
  for (std::size_t k = 0; k < spans_of[rod].size(); ++k) {
    const std::uint32_t i = spans_of[rod][k];
    motions[i] = motion(mesh.spans[i], way.spans[k], share, now);
    if (!(motions[i] < kInfinite)) motions[i] = far_at_most(i, way, share, now);
  }
}

/// Where a curve turns round within a span, bounds by its Bezier points say nothing, and an infinite one
/// would refuse a state that is sound: what is bound to it is placed at both ends of its way and now, by this
/// rod's shares alone, since others go their own.
double SelfModel::far_at_most(std::size_t span, const RodWay& way, double share, const CurvePair& now) const {
  const std::size_t rod = mesh.spans[span].pair;
  std::vector<Vec3> p = way.p, arm = way.arm;
  const CurvePair from = curve(rod, p, arm);
  for (std::size_t i = 0; i < p.size(); ++i) p[i] += way.p_change[i], arm[i] += way.arm_change[i];
  const CurvePair to = curve(rod, p, arm);
  double most = 0.0;
  std::vector<BoundShare> shares;
  for (const std::uint32_t vertex : mesh.bound_to[span]) {
    points().points().shares(vertex, shares);
    for (const BoundShare& one : shares) {
      if (one.pair != rod) continue;
      const Vec3 taken = (1.0 - share) * from_axial(from, one.record) + share * from_axial(to, one.record);
      most = std::max(most, (from_axial(now, one.record) - taken).norm());
    }
  }
  return most * (1.0 + 1e-9);
}

std::vector<Vec3> SelfModel::place(std::span<const CurvePair> pairs) const {
  std::vector<Vec3> result(all_.size());
  points().points().place(pairs, all_, result);
  return result;
}

}  // namespace tendril::contact
