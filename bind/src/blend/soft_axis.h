#pragma once

#include "branches.h"

/// How a point is bound where its nearest projection is not the only one that counts.
namespace tendril::bind {

/// A point p of the mesh, and what is known about it.
struct Site {
  const Vec3& p;
  double scale;  ///< r of BindOptions::band: at least the distance to the nearest point
  /// What bears on each curve: the factor of Ways at p, over that of the nearest, and at least how far p is.
  struct Curve {
    double factor, least;
  };
  std::vector<Curve> curves;
  std::span<const Candidate> all;  ///< every projection that counts, or the nearest alone; the nearest first
  std::optional<double> flatness = {};  ///< once it is known

  const Candidate& nearest() const { return all.front(); }
};

/// The part of the axes around a point p, weighted by distance alone, and how much of it is blended in.
///
/// Weights. With d the distance to the nearest point, `reach` = d + 2 band scale and
///
///   e(t) = (|c(t) - p|^2 - d^2) / (reach^2 - d^2),
///
/// a piece ds of a curve has the weight (1 - max(0, e))^3 ds where e < 1, and 0 elsewhere: the integrand and
/// its first two derivatives vanish at e = 1, so the weights are smooth in p whether projections appear,
/// vanish, merge or exchange their ranks. (A choice among projections, by whatever weights, is singular where
/// two of them merge.) They are distributed to fixed nodes of each curve, two a span, by linear interpolation
/// in t; a point is bound to these nodes.
///
/// Cut margin. Let c be the nearest point and n = (p - c) / |p - c|. A point q = c + s n of the ray through p
/// has its nearest point at c as long as |q - c(t)|^2 >= s^2 for all t. With D = c(t) - c that reads
/// |D|^2 - 2 s n . D >= 0, hence
///
///   s <= tau = min over t of |D|^2 / (2 n . D)   (n . D > 0),
///
/// the cut distance; for c(t) -> c the bound tends to |c'|^2 / (n . c''), the radius of curvature along n. So
///
///   1 - |p - c| / tau = min over t of (|c(t) - p|^2 - |c - p|^2) / |D|^2
///
/// is 0 on the cut locus and continuous where c is. It is compared with `band`. Two branches of the axis, a
/// small |D| apart, exchange the nearest point across the bisecting plane of c and c(t), from which p is
/// (|c(t) - p|^2 - |c - p|^2) / (2 |D|) away; that distance is to be compared with band scale, so for them
/// the term is divided by 2 scale / |D| as well. Branches are told by the arc between c and c(t): the divisor
/// is the arc over 2 |D|, but at least 1 and at most 2 scale / |D|; for another curve it is the latter.
/// Before c jumps to a point close by on the same branch, the distance has a flat maximum between the two
/// that no term sees: see flatness().
///
/// Distances to a curve are multiplied by its factor throughout. `band` is that of BindOptions.
class SoftAxis {
 public:
  SoftAxis(std::span<const CurveProjector> projectors, double band);

  /// Of all curves, ascending.
  std::vector<Node> nodes() const;

  /// A point of a curve.
  Vec3 value(std::uint32_t pair, double t) const;

  /// The nodes with a weight, which sum to 1. Projections that are not open are left out with their part of
  /// the curve.
  std::vector<Influence> influences(const Site& site) const;

  /// Distance from p beyond which nothing counts.
  double reach(const Site& site) const { return site.nearest().at.distance + width(site); }

  /// The least of the terms above, each over the band: 0 on the cut locus, 1 and more beyond the band.
  double cut_margin(Site& site) const;
  /// b of Binding: 1 up to the margin 0.08, falling to 0 at the margin 1 with a continuous derivative.
  static double blend_weight(double margin);

  /// False where cut_margin() is at least 1, whatever other projections there are; cheaper, and needs none of
  /// them.
  bool may_be_ambiguous(Site& site) const;

 private:
  /// The curve between two knots: sum_j c_j s^j, s from 0 to 1.
  struct Polynomial {
    double begin, end;
    std::vector<Vec3> c;

    Vec3 value(double t) const;
  };
  static Polynomial polynomial(const BezierPiece& piece);
  /// Samples that follow each other, first and last included, within a ball. Of most, all are too far to
  /// matter, which one look at the ball tells.
  struct Block {
    Vec3 centre;
    double radius;
    std::size_t first, last;
    Vec3 tangent;              ///< of one of them
    double spread, curvature;  ///< most by which tangents differ from it; largest
  };
  struct Curve {
    const BSpline* curve;
    double speed;               ///< bound on |c'|
    std::vector<double> nodes;  ///< parameters, ascending, ends included
    std::uint32_t first_node;   ///< index of the first of them among those of all curves
    /// Samples for the cut distance: their parameters, and the length of the chain of samples up to each.
    std::vector<double> parameters, lengths;
    std::vector<Vec3> points, tangents, curvatures;
    double spacing = 0.0;  ///< largest distance of consecutive samples
    std::vector<Polynomial> polynomials;
    std::vector<Block> blocks;

    double length(double t) const;
  };
  struct Sample {
    double t, excess;  ///< excess: e(t)
    Vec3 point;
  };

  static constexpr double kRoom = 1e-9;  ///< for rounding, relative

  double width(const Site& site) const { return 2.0 * band_ * site.scale; }
  /// False where no sample of a curve bears on the margin, as all of it is too far from p.
  bool may_bear(const Site& site, std::uint32_t pair) const;
  /// Least, over the samples, of e + (max(lambda, 0) + |cosine|) / band: e is the excess of their distance
  /// over d in units of band scale, lambda as of a projection, cosine that between the tangent and the
  /// direction to p. Where two critical points of the distance are about to appear, lambda and the cosine,
  /// which are its second and first derivative up to factors, vanish together.
  double flatness(Site& site) const;
  /// The same within a block, at least; cheap.
  double least_flatness(const Site& site, std::uint32_t pair, const Block& block) const;
  /// The same between the samples first and first + 1.
  double flatness(const Site& site, std::uint32_t pair, std::size_t first) const;
  std::vector<Sample> samples(const Site& site, std::uint32_t pair, double step) const;
  /// What of the way a distance may be from the nearest one, and still count, squared.
  double room(const Site& site) const {
    return width(site) * (2.0 * site.nearest().at.distance + width(site));
  }
  static std::vector<Block> blocks_of(const Curve& curve);
  /// Least distance of a block's samples from p, and most from the nearest point of the site.
  struct Bounds {
    double away, apart;
  };
  static Bounds bounds_of(const Block& block, const Site& site);
  bool is_clear(const Site& site, std::uint32_t pair, const Block& block) const;
  bool any_ambiguous(const Site& site, std::uint32_t pair, const Block& block) const;
  static void raise_behind_maxima(std::span<const double> minima, std::vector<Sample>& along);
  static void distribute(const Curve& curve, std::span<const Sample> along, double part,
                         std::vector<double>& weight);

  double band_;
  std::vector<Curve> curves_;
};

}  // namespace tendril::bind
