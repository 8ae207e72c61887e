#pragma once

#include "branches.h"

/// How a point is bound where its nearest projection is not the only one that counts.
namespace tendril::bind {

/// A point of the mesh, and what is known about it.
struct Site {
  const Vec3& p;
  double scale;                    ///< at least the distance to the nearest place; widths are in units of it
  std::vector<double> factors;     ///< those of Facing at p, one for each curve, over that of the nearest
  std::span<const Candidate> all;  ///< every projection that counts, or the nearest alone; the nearest first

  const Candidate& nearest() const { return all.front(); }
};

/// The places of the axes near a point, weighted by their closeness alone: with d the distance to the nearest
/// and r = d + 2 band scale, a piece ds of a curve has the weight (1 - e)^3 ds, e = (|c(t) - p|^2 - d^2) /
/// (r^2 - d^2), for e < 1. Nothing in it jumps when p moves, whether projections come, go, change places or
/// merge; unlike a choice among projections it has no singular points either. The weights are laid down on
/// fixed places of each curve, two a span, by linear interpolation in t.
///
/// Distances to a curve count so many times as much as its factor says. `band` is that of BindOptions.
class SoftAxis {
 public:
  SoftAxis(std::span<const CurveProjector> projectors, double band);

  /// Projections that are not open are left out with their part of the curve.
  std::vector<Influence> influences(const Site& site) const;

  /// Distance from the point beyond which no place counts.
  double reach(const Site& site) const { return site.nearest().at.distance + width(site); }

  /// How far p is from where its nearest projection jumps or splits: 0 there; 1 and more beyond the band.
  ///
  /// Going from the nearest point c straight through p, c stays the nearest up to the cut distance
  /// tau = min over all curves and t of |D|^2 / (2 n . D), D = c(t) - c, n = (p - c) / |p - c|; for t -> c
  /// that is the radius of curvature along n. |p - c| / tau is continuous in p wherever c is, and 1 wherever
  /// c is not; what it lacks to 1 is compared with `band`. A strand of the axis that is near c, but far along
  /// the axis, takes over across a plane in their middle: there the distance of p to the plane is compared
  /// with band scale. Where c is about to jump to a place close by, the distance has a flat hump between the
  /// two, before they are equally near: see flatness().
  double lack(const Site& site) const;
  /// What the places around have in the point: 1 at no lack, 0 at a lack of 1.
  static double share(double lack);

  /// False where lack() is at least 1, whatever other projections there are; cheaper, and needs none of them.
  bool may_be_ambiguous(const Site& site) const;

 private:
  struct Curve {
    const BSpline* curve;
    double speed;               ///< bound on |c'|
    std::vector<double> nodes;  ///< ascending, ends included
    /// Along it, where the cut distance is looked for, and how far along that is.
    std::vector<double> parameters, lengths;
    std::vector<Vec3> points, tangents, curvatures;
    double spacing = 0.0;  ///< longest of points

    double length(double t) const;
  };
  struct Sample {
    double t, excess;
    Vec3 point;
  };

  double width(const Site& site) const { return 2.0 * band_ * site.scale; }
  /// Least of e + (max(lambda, 0) + |cosine|) / band over the places: e is the excess of their distance in
  /// units of band scale, lambda as of a projection, the cosine is that between tangent and way to p. Both
  /// are 0 where a pair of projections is born.
  double flatness(const Site& site) const;
  double flatness(const Site& site, std::uint32_t pair, std::size_t first) const;
  std::vector<Sample> samples(const Site& site, std::uint32_t pair) const;
  static void raise_behind_humps(std::span<const double> minima, std::vector<Sample>& along);
  static void lay_down(const Curve& curve, std::span<const Sample> along, std::vector<double>& weight);

  double band_;
  std::vector<Curve> curves_;
};

}  // namespace tendril::bind
