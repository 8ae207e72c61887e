#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>
#include <tendril/curve/frames.h>

#include <span>
#include <vector>

namespace tendril {

/// A point of the primary curve with the frame there.
struct CurveFrame {
  Vec3 origin;                           ///< c(t)
  Frame frame;                           ///< (l_x, l_y, l_z), orthonormal whatever the status
  FrameStatus status = FrameStatus::ok;  ///< why the frame is degenerate
  double sine = 1.0;  ///< of the angle between c_D - c and the tangent; 0 where the frame degenerates
};

/// An axial curve-pair ([Hui 2002]; [Chan 2008] section 2.2): the primary curve c(t) and the orientation
/// curve c_D(t) on the same knots. Only the direction of c_D(t) - c(t) across the tangent matters, and, where
/// a rod is twisted by more than the side of the orientation curve can show, a turn beyond it.
class TENDRIL_CORE_API CurvePair {
 public:
  /// Throws InvalidInput on the wrong number of control points or one that is not finite.
  CurvePair(const KnotVector& knots, std::vector<Vec3> primary, std::vector<Vec3> orientation);

  const KnotVector& knots() const { return primary_.knots(); }  ///< of both curves
  const BSpline& primary() const { return primary_; }           ///< c
  const BSpline& orientation() const { return orientation_; }   ///< c_D
  /// Replaces the control points of both. Throws as the constructor does; then one may have changed already.
  void set_control_points(Points primary, Points orientation);

  /// The frame is turned about l_z by theta(t) = sum_i N_i(t) turn_i [rad, right-handed] from where the
  /// orientation curve has it. Stays when control points are replaced.
  /// \param turn  finite, one per control point, or none (no turn); else InvalidInput
  void set_turn(std::vector<double> turn);
  std::span<const double> turn() const { return turn_; }  ///< as set

  /// l_z = c'/|c'|, l_x = unit((c_D - c) cross l_z), l_y = l_z cross l_x ([Chan 2008] 2.4, normalised),
  /// turned by theta(t), at t clamped to the domain. Speed counts as zero below 1e-14 of the control
  /// polygon's diagonal per length of the domain.
  CurveFrame frame(double t) const;

  /// Diagonal of the primary control polygon's bounding box per length of the domain: what a speed |c'| is
  /// compared with.
  double scale_of_speed() const { return scale_of_speed_; }

  /// Same as frame(t) from a basis row with at least one derivative, evaluated by the caller (or once for all
  /// curve-pairs on the same knots). Bit for bit what frame(t) gives.
  CurveFrame frame(const Basis& basis, double t) const;

 private:
  Vec3 tangent_at_zero_speed(double t) const;
  void measure();

  BSpline primary_;
  BSpline orientation_;
  std::vector<double> turn_;
  double scale_of_speed_ = 0.0;
};

}  // namespace tendril
