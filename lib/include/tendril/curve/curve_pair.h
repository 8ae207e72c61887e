#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>
#include <tendril/curve/frames.h>

#include <vector>

namespace tendril {

/// A point of the primary curve with the frame there.
struct CurveFrame {
  Vec3 origin;
  Frame frame;
  FrameStatus status = FrameStatus::ok;
  double sine =
      1.0;  ///< of the angle between the offset c_D - c and the tangent; 0 where the frame degenerates
};

/// An axial curve-pair (thesis 2.2): the primary curve c(t) and the orientation curve c_D(t) on the same
/// knots. Only the direction of c_D(t) - c(t) across the tangent matters.
class TENDRIL_CORE_API CurvePair {
 public:
  /// Throws InvalidInput on the wrong number of control points or one that is not finite.
  CurvePair(const KnotVector& knots, std::vector<Vec3> primary, std::vector<Vec3> orientation);

  const KnotVector& knots() const { return primary_.knots(); }
  const BSpline& primary() const { return primary_; }
  const BSpline& orientation() const { return orientation_; }
  void set_control_points(Points primary, Points orientation);

  /// l_z = c'/|c'|, l_x = unit((c_D - c) cross l_z), l_y = l_z cross l_x (thesis 2.4, normalised), at t
  /// clamped to the domain. Speed counts as zero below 1e-14 of the control polygon's diagonal per length of
  /// the domain.
  CurveFrame frame(double t) const;

  /// Diagonal of the primary control polygon per length of the domain: what speeds compare with.
  double scale_of_speed() const { return scale_of_speed_; }

  /// Same as frame(t) from a basis row with at least one derivative, evaluated by the caller (or once for all
  /// curve-pairs on the same knots). Bit for bit what frame(t) gives.
  CurveFrame frame(const Basis& basis, double t) const;

 private:
  Vec3 tangent_at_zero_speed(double t) const;
  void measure();

  BSpline primary_;
  BSpline orientation_;
  double scale_of_speed_ = 0.0;
};

}  // namespace tendril
