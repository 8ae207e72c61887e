#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_axis.h"

namespace tendril::bind {
namespace {

constexpr double kRounding = 1e-9;  ///< of places, over the scale, at most

/// 1 up to `from`, 0 from `to` on, with a continuous derivative.
double fall(double x, double from, double to) {
  const double s = std::clamp((to - x) / (to - from), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace

SoftAxis::Bounds SoftAxis::bounds_of(const Block& block, const Site& site) {
  const double away = (site.p - block.centre).norm(), apart = (site.nearest().at.point - block.centre).norm();
  return {away - block.radius - kRoom * away, apart + block.radius + kRoom * apart};
}

/// Where the cosine changes its sign between the two samples it is 0 in between.
double SoftAxis::flatness(const Site& site, std::uint32_t pair, std::size_t first) const {
  const Curve& curve = curves_[pair];
  double away = std::numeric_limits<double>::infinity(), lambda = away, cosines[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 way = site.p - curve.points[first + k];
    const double distance = way.norm();
    away = std::min(away, distance);
    lambda = std::min(lambda, std::max(0.0, 1.0 - curve.curvatures[first + k].dot(way)));
    cosines[k] = distance > 0.0 ? curve.tangents[first + k].dot(way) / distance : 0.0;
  }
  const bool turns = cosines[0] * cosines[1] <= 0.0;
  const double cosine = turns ? 0.0 : std::min(std::abs(cosines[0]), std::abs(cosines[1]));
  const double excess = std::max(0.0, site.curves[pair].factor * away - site.nearest().at.distance);
  return excess / (band_ * site.scale) + (lambda + cosine) / band_;
}

/// A tangent t and the way w to p of a sample have |t . w| >= |t0 . w0| - |t - t0| |w0| - |w - w0|, which is
/// the cosine times |w|, and where that is above 0 the cosine changes no sign.
double SoftAxis::least_flatness(const Site& site, std::uint32_t pair, const Block& block) const {
  const Vec3 way = site.p - block.centre;
  const double length = way.norm(), most = (length + block.radius) * (1.0 + kRoom);
  const double along = std::abs(block.tangent.dot(way)) - (block.spread + kRoom) * length - block.radius;
  const double cosine = along > 0.0 ? along / most : 0.0,
               lambda = std::max(0.0, 1.0 - block.curvature * most);
  const double away = site.curves[pair].factor * (length - block.radius - kRoom * length);
  const double excess = std::max(0.0, away - site.nearest().at.distance);
  return (excess / (band_ * site.scale) + (lambda + cosine) / band_) * (1.0 - kRoom) - kRoom;
}

double SoftAxis::flatness(Site& site) const {
  if (site.flatness) return *site.flatness;
  double least = 1.0;
  for (std::uint32_t pair = 0; pair < curves_.size(); ++pair) {
    if (!may_bear(site, pair)) continue;
    const std::vector<Vec3>& points = curves_[pair].points;
    const double reach = (site.nearest().at.distance + band_ * site.scale) / site.curves[pair].factor;
    for (const Block& block : curves_[pair].blocks) {
      const double most = (reach + block.radius) * (1.0 + kRoom);
      if ((site.p - block.centre).squaredNorm() > most * most) continue;
      if (least_flatness(site, pair, block) >= least) continue;
      bool near = (site.p - points[block.first]).squaredNorm() < reach * reach;
      for (std::size_t k = block.first + 1; k <= block.last; ++k) {
        const bool before = near;
        near = (site.p - points[k]).squaredNorm() < reach * reach;
        if (before || near) least = std::min(least, flatness(site, pair, k - 1));
      }
    }
  }
  site.flatness = least;
  return least;
}

double SoftAxis::cut_margin(Site& site) const {
  const Candidate& nearest = site.nearest();
  const double distance2 = (site.p - nearest.at.point).squaredNorm();
  const double here = curves_[nearest.pair].length(nearest.at.t);
  const double least_apart = kRounding * site.scale, least_apart2 = least_apart * least_apart;
  double margin = std::min(nearest.at.strength / band_, flatness(site));
  const auto consider = [&](std::uint32_t pair, double length, const Vec3& point) {
    const double factor = site.curves[pair].factor, apart2 = (point - nearest.at.point).squaredNorm();
    // Too near to the nearest point to differ from it: there the term tends to lambda, which is counted. Of a
    // mesh's point on the axis both are rounding.
    if (!(apart2 > std::max(1e-6 * distance2, least_apart2))) return;
    const double apart = std::sqrt(apart2), branches = std::max(1.0, 2.0 * site.scale / apart);
    const double excess = factor * factor * (point - site.p).squaredNorm() - distance2;
    if (excess >= margin * band_ * branches * apart2) return;
    const double round = pair == nearest.pair ? std::abs(length - here) / (2.0 * apart) : branches;
    margin = std::min(margin, excess / (apart2 * band_ * std::clamp(round, 1.0, branches)));
  };
  for (std::uint32_t pair = 0; pair < curves_.size(); ++pair) {
    if (!may_bear(site, pair)) continue;
    for (const Block& block : curves_[pair].blocks) {
      const auto [away, apart] = bounds_of(block, site);
      const double least = site.curves[pair].factor * std::max(0.0, away);
      const double branches_apart2 = apart * std::max(apart, 2.0 * site.scale);
      if ((least * least) * (1.0 - kRoom) - distance2 >= std::max(0.0, margin) * band_ * branches_apart2)
        continue;
      for (std::size_t k = block.first; k <= block.last; ++k)
        consider(pair, curves_[pair].lengths[k], curves_[pair].points[k]);
    }
  }
  for (const Candidate& c : site.all.subspan(1)) consider(c.pair, curves_[c.pair].length(c.at.t), c.at.point);
  return margin;
}

double SoftAxis::blend_weight(double margin) {
  return fall(margin, 0.08, 1.0);
}

bool SoftAxis::may_be_ambiguous(Site& site) const {
  if (site.nearest().at.strength < band_ || flatness(site) < 1.0) return true;
  for (std::uint32_t pair = 0; pair < curves_.size(); ++pair)
    for (std::size_t b = 0; may_bear(site, pair) && b < curves_[pair].blocks.size(); ++b) {
      const Block& block = curves_[pair].blocks[b];
      if (!is_clear(site, pair, block) && any_ambiguous(site, pair, block)) return true;
    }
  return false;
}

/// With a the distance of a sample from p, less the samples' spacing, b = d + twice the spacing, d the
/// distance and f the factor: the sample is at most a + b from the nearest point, and the terms of the margin
/// are at least 1 where f a >= d + band scale and
///
///   f^2 a^2 - d^2 >= band (a + b) max(a + b, 2 scale).
///
/// That holds for all a from one on where both forms of it, with either of the two, hold and rise in a.
bool SoftAxis::may_bear(const Site& site, std::uint32_t pair) const {
  const Candidate& nearest = site.nearest();
  if (pair == nearest.pair) return true;
  const double spacing = curves_[pair].spacing, d = nearest.at.distance * (1.0 + kRoom),
               f = site.curves[pair].factor;
  const double a = (site.curves[pair].least - spacing) * (1.0 - kRoom), b = d + 2.0 * spacing;
  if (!(a > 0.0 && f * a >= d + band_ * site.scale * (1.0 + kRoom))) return true;
  const double band = band_ * (1.0 + kRoom), left = f * f * a * a - d * d;
  return !(left >= band * (a + b) * std::max(a + b, 2.0 * site.scale) && f * f * a >= band * (a + b) &&
           f * f * a >= band * site.scale);
}

/// Whether no sample of a block can be one that any_ambiguous() looks for: none is nearer to p, or farther
/// from the nearest point, than the bounds.
bool SoftAxis::is_clear(const Site& site, std::uint32_t pair, const Block& block) const {
  const double distance = (site.p - site.nearest().at.point).norm(), spacing = curves_[pair].spacing;
  const Bounds bounds = bounds_of(block, site);
  const double apart = bounds.apart + spacing;
  const double away = std::max(distance, site.curves[pair].factor * (bounds.away - spacing) * (1.0 - kRoom));
  return (away - distance) * (away + distance) >=
         band_ * apart * std::max(apart, 2.0 * site.scale) * (1.0 + kRoom);
}

bool SoftAxis::any_ambiguous(const Site& site, std::uint32_t pair, const Block& block) const {
  const Candidate& nearest = site.nearest();
  const Curve& curve = curves_[pair];
  const double distance = (site.p - nearest.at.point).norm();
  const double here = curves_[nearest.pair].length(nearest.at.t);
  for (std::size_t k = block.first; k <= block.last; ++k) {
    double apart = (curve.points[k] - nearest.at.point).norm(), away = (curve.points[k] - site.p).norm();
    // Between samples another branch may come nearer; the branch of the nearest point does not.
    const bool own =
        pair == nearest.pair && std::abs(curve.lengths[k] - here) <= 2.0 * apart + 2.0 * curve.spacing;
    if (!own) {
      apart += curve.spacing;
      away = std::max(distance, site.curves[pair].factor * (away - curve.spacing));
    }
    const double branches = own ? 1.0 : std::max(1.0, 2.0 * site.scale / apart);
    if (own && !(apart > std::max(1e-3 * distance, kRounding * site.scale))) continue;
    if ((away - distance) * (away + distance) < band_ * branches * apart * apart) return true;
  }
  return false;
}

}  // namespace tendril::bind
