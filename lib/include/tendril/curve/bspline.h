#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>
#include <tendril/curve/knots.h>

#include <vector>

namespace tendril {

/// Linear combination of control points with a basis row: the order-th derivative of the curve the points
/// belong to. Shared by all curves on the same knots, so that a curve-pair evaluates its basis once.
TENDRIL_CORE_API Vec3 combine(const Basis& basis, int degree, Points control_points, int order = 0);

/// One polynomial piece in Bernstein form: c(t) = sum_j B_{j,p}((t - begin) / (end - begin)) points[j].
struct BezierPiece {
  double begin;              ///< parameter of the first point
  double end;                ///< of the last, begin < end
  std::vector<Vec3> points;  ///< degree + 1
};

/// Clamped non-rational B-spline curve, c(t) = sum_i N_{i,p}(t) u_i ([Chan 2008] 2.5), t in [knots.start(),
/// knots.end()]. Parameters outside are clamped.
class TENDRIL_CORE_API BSpline {
 public:
  /// \param knots           give the degree p and the domain
  /// \param control_points  as many as knots.control_points(), all finite; else InvalidInput
  BSpline(KnotVector knots, std::vector<Vec3> control_points);

  const KnotVector& knots() const { return knots_; }         ///< as given
  int degree() const { return knots_.degree(); }             ///< 1 to kMaxDegree
  Points control_points() const { return control_points_; }  ///< u_i, valid as long as the curve

  /// Replaces the control points (same count, finite).
  void set_control_points(Points control_points);

  /// c(t). O(p^2), no allocation; NaN for NaN.
  Vec3 value(double t) const;
  /// The order-th derivative by t, order 1 to 3; one-sided at knots as KnotVector::basis says.
  Vec3 derivative(double t, int order = 1) const;

  /// The curve's polynomial pieces, one per non-empty span, by blossoming [Ramshaw 1989]. O(n p^3).
  std::vector<BezierPiece> bezier_pieces() const;

 private:
  KnotVector knots_;
  std::vector<Vec3> control_points_;
};

}  // namespace tendril
