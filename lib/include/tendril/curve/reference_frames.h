#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/bspline.h>
#include <tendril/curve/frames.h>

#include <span>

namespace tendril {

/// Frames a single curve defines without an orientation curve, to compare the frame of a CurvePair with. All
/// have z = c'/|c'| and are orthonormal and right-handed whatever their status. A derivative counts as zero
/// below 32 times the rounding error of its sum; the tangent is then that of the first derivative that does
/// not vanish, seen forwards except at the end of the domain. Parameters are clamped to the domain.

/// Frenet frame ([Chan 2008] 2.3): y the principal normal, x = y cross z the negative binormal.
struct FrenetFrame {
  Frame frame;  ///< orthonormal whatever the status
  /// zero_speed; zero_offset or offset_along_tangent where the curvature vanishes (c'' zero, or along c'),
  /// with y towards the least aligned world axis.
  FrameStatus status = FrameStatus::ok;
  double curvature = 0.0;  ///< |c' x c''| / |c'|^3, one per length; 0 unless ok
  double torsion = 0.0;    ///< (c' x c'') . c''' / |c' x c''|^2, signed; 0 unless ok
};
/// \param curve  any
/// \param t      clamped to the domain
TENDRIL_CORE_API FrenetFrame frenet_frame(const BSpline& curve, double t);

/// Frame with x = unit(d cross z): y is the part of d across the tangent. Degenerate (offset_along_tangent)
/// where the sine of the angle between d and the tangent is below 1e-12.
/// \param curve  any
/// \param t      clamped to the domain
/// \param d      finite and not zero, of any length; else InvalidInput
TENDRIL_CORE_API FrameChoice directional_frame(const BSpline& curve, double t, const Vec3& d);

/// Rotation-minimising frames by double reflection [Wang et al. 2008]: the frame at each parameter is that of
/// the one before, reflected in the bisecting plane of the two points and then in that of the two tangents.
/// The error against the exact frame falls with the fourth power of the step.
///
/// Status of a frame other than the first: zero_speed; zero_edge where the two points coincide (the smallest
/// rotation between the tangents is used); fold_back where the second reflection has no plane.
/// \param curve       any
/// \param parameters  at least one, not decreasing, no NaN; else InvalidInput
/// \param y           direction that the first frame's y takes across the tangent, as in directional_frame
TENDRIL_CORE_API NodeFrames rotation_minimising_frames(const BSpline& curve,
                                                       std::span<const double> parameters, const Vec3& y);

}  // namespace tendril
