#pragma once

#include "branches.h"

/// How a point is bound where its nearest projection is not the only one that counts.
namespace tendril::bind {

/// The places of the axes near a point, weighted by their closeness alone: with d the distance to the nearest
/// and e = (|c(t) - p| - d) / (width d), a piece ds of a curve has the weight (1 - e)^3 ds for e < 1. Nothing
/// in it jumps when p moves, whether projections come, go, change places or merge; unlike a choice among
/// projections it has no singular points either. The weights are laid down on fixed places of each curve, two
/// a span, by linear interpolation in t.
///
/// `factors` are those of Facing at p, one for each curve: the distances to it count so many times as much,
/// in units of the factor of the nearest.
class SoftAxis {
 public:
  explicit SoftAxis(std::span<const CurveProjector> projectors);

  /// \param all  every projection of p within `width` of the nearest; those not open are left out with their
  ///             part of the curve
  std::vector<Influence> influences(const Vec3& p, std::span<const Candidate> all,
                                    std::span<const double> factors, double width) const;

  /// How close p is to where its nearest projection jumps or splits: 1 there, 0 beyond `band`.
  ///
  /// Going from the nearest point c straight through p, c stays the nearest up to the cut distance
  /// tau = min over all curves and t of |D|^2 / (2 n . D), D = c(t) - c, n = (p - c) / |p - c|; for t -> c
  /// that is the radius of curvature along n. |p - c| / tau is continuous in p wherever c is, and 1 wherever
  /// c is not; what it lacks to 1 is compared with `band`. A strand of the axis that is near c, but far along
  /// the axis, takes over across a plane in their middle: there the distance of p to the plane is compared
  /// with band |p - c|.
  double ambiguity(const Vec3& p, std::span<const Candidate> all, std::span<const double> factors,
                   double band) const;

  /// False where ambiguity() is 0, whatever other projections there are; cheaper, and needs none of them.
  bool may_be_ambiguous(const Vec3& p, const Candidate& nearest, std::span<const double> factors,
                        double band) const;

 private:
  struct Curve {
    const BSpline* curve;
    double speed;               ///< bound on |c'|
    std::vector<double> nodes;  ///< ascending, ends included
    /// Along it, where the cut distance is looked for, and how far along that is.
    std::vector<double> parameters, lengths;
    std::vector<Vec3> points;
    double spacing = 0.0;  ///< longest of points

    double length(double t) const;
  };
  struct Sample {
    double t, excess;
    Vec3 point;
  };
  static void lay_down(const Curve& curve, std::span<const Sample> along, std::vector<double>& weight);
  std::vector<Sample> samples(const Curve& curve, const Vec3& p, std::span<const double> minima,
                              double nearest, double factor, double width) const;

  std::vector<Curve> curves_;
};

}  // namespace tendril::bind
