#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>

#include <memory>
#include <vector>

namespace tendril {

/// Where on the curve a nearest point lies.
enum class ProjectionKind {
  interior,  ///< the offset is orthogonal to the tangent
  start,     ///< t is the start of the domain
  end,       ///< t is the end of the domain
  joint      ///< an interior knot where the distance has a kink, or a point where the curve's speed is zero
};

/// A nearest point c(t) of a point p, and what is known about it.
struct Projection {
  double t;             ///< in the curve's domain
  Vec3 point;           ///< BSpline::value(t), to the last bit
  double distance;      ///< |point - p|
  ProjectionKind kind;  ///< decides which condition t meets
  /// 1 - curvature . offset = ((c - p) . c')' / |c'|^2 at t (the right-hand side at a knot). Positive at a
  /// regular minimum, 0 at a focal point (centre of curvature); 0 by convention where the speed is zero.
  double lambda;
  /// Proven: distance - gap <= true minimum <= distance. Same unit as distance.
  double gap;
};

/// A local minimum of the distance along the curve.
struct LocalMinimum : Projection {
  /// 0 where the minimum is about to be born or to die, and continuous where it wanders over a joint or into
  /// an end: lambda (at least 0) inside; plus the cosine between offset and tangent at an end; at a kink the
  /// means of its two sides, each weighted by the other's cosine.
  double strength;
  /// Set where double-double arithmetic cannot tell the critical points of the distance apart: closer than
  /// 1e-8 of their span, or a point of zero speed.
  bool cluster;
  int multiplicity;  ///< of a cluster: at most so many critical points, with multiplicity; else 1
};

/// Nearest point on a B-spline, for every finite point: ends, joints, points of zero speed and overlaps
/// included.
///
/// Branch and bound with a certificate. Each span is cut into Bezier sub-pieces held in a binary tree of
/// capsules (chord and radius, by the convex hull property). On a sub-piece the squared distance is a
/// polynomial of degree 2 p, whose Bernstein coefficients are formed from control points *relative to p*, so
/// that their rounding errors scale with the local distance and not with the origin's. A sub-piece is dropped
/// when a forward error bound shows it to be farther than a distance already attained; it is resolved when
/// its coefficients prove it monotone, strictly convex (one root, by safeguarded Newton) or constant to 1e-14
/// of the size; otherwise it is halved. All candidates are compared by the distance evaluated at t itself.
///
/// Size below is the diagonal of the control points' bounding box plus the distance of the point to it.
/// Accuracy: distance exceeds the true minimum by at most `gap`, which stays near 1e-14 of the size (plus
/// rounding relative to the largest coordinate of a curve far from the origin). Equal distances: the smallest
/// t wins. Coordinates up to 1e150; squares must not overflow.
///
/// Cost: O(log spans) for a point near the curve compared with its other branches, no allocation. Immutable
/// after construction and cheap to copy; may be shared between threads.
class TENDRIL_CORE_API CurveProjector {
 public:
  /// \param curve  copied; control points up to 1e150, else InvalidInput. O(spans)
  explicit CurveProjector(const BSpline& curve);

  /// InvalidInput when p is not finite or beyond 1e150.
  Projection nearest(const Vec3& p) const;

  /// Same result, bit for bit; `hint` is a parameter thought to be close to it (a neighbour's), which bounds
  /// the search from the start. Clamped to the domain; a NaN is InvalidInput.
  Projection nearest(const Vec3& p, double hint) const;

  /// Of many points: each the same as nearest(p), bit for bit, in a fraction of the time, as points that lie
  /// together share a search in vector lanes. Any order. InvalidInput names the point.
  std::vector<Projection> nearest(Points points) const;

  /// All local minima of the distance that are at most (1 + band) times as far as the nearest: the nearest
  /// first, the others in the order of t. The first is nearest() bit for bit, but where the distance is so
  /// flat that two parameters 1e-7 of the domain apart differ by rounding only: then this one is the more
  /// accurate in t. `gap` bounds each one's difference from the true local minimum it stands for.
  ///
  /// Complete: the slope of the squared distance is signed by its Bernstein coefficients under a forward
  /// error bound against the exact curve, in double-double arithmetic where a double cannot; what keeps an
  /// unknown sign is reported as a cluster. A minimum at a distance within rounding of the band's edge may be
  /// in or out. Cost: nearest(), and as much again per piece of the curve within the band.
  /// \param p     as for nearest
  /// \param band  0 or more; infinity for all minima there are. A negative one or NaN is InvalidInput
  std::vector<LocalMinimum> all(const Vec3& p, double band) const;
  /// Same result, bit for bit, with the hint of nearest.
  std::vector<LocalMinimum> all(const Vec3& p, double band, double hint) const;

  const BSpline& curve() const;  ///< the copy

  struct Data;  ///< what is precomputed; private to the implementation

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace tendril
