#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/curve_pair.h>

#include <optional>
#include <span>
#include <string>

/// Whether frames that are given at some places carry on from each to the next. A curve-pair whose
/// orientation curve passes through the primary one, or whose primary curve folds back, has frames on either
/// side that no frame in between joins: what follows it is torn there.
namespace tendril {

/// The angle from a.y, carried by the smallest rotation that takes a.z to b.z, to b.y about b.z, by the
/// right-hand rule, in [-pi, pi] [rad].
/// \param a, b  orthonormal
TENDRIL_CORE_API double turn_between(const Frame& a, const Frame& b);

/// What stops the frame between two parameters of a curve-pair.
struct FrameJump {
  /// Which.
  enum class Cause {
    no_frame,   ///< a frame that is not FrameStatus::ok, but for points of zero speed without a fold
    fold_back,  ///< the tangent turns by more than 90 degrees in a step of a sixteenth, or 120 in two
    flip,       ///< the frame does, about the tangent
    turn        ///< the frame turns by more than 90 degrees in all from one station to the next
  };
  Cause cause = Cause::no_frame;  ///< the first one met
  std::size_t station = 0;        ///< the interval is that from this station to the next
  double t = 0.0;                 ///< parameter where it was seen
  double angle = 0.0;             ///< by which the frame or the tangent turns there [rad]; 0 for no_frame
};

/// The first place, along the curve, where the frame does not carry on, looked for in sixteen steps between
/// stations; none where it carries on everywhere. O(16 stations). What happens and is undone within one of
/// these steps is not seen.
/// \param pair      any
/// \param stations  ascending parameters within its domain, two or more, else InvalidInput: those of the
///                  masses (Interpolator::parameters), between which a turn is known only up to whole turns
TENDRIL_CORE_API std::optional<FrameJump> find_frame_jump(const CurvePair& pair,
                                                          std::span<const double> stations);

/// The same for a curve-pair given by its control points: stations are its knots, between which the frame may
/// turn by any angle.
TENDRIL_CORE_API std::optional<FrameJump> find_frame_jump(const CurvePair& pair);

/// What happened between two neighbours, for a message: "the frame turns by 180 degrees between nodes 5 and
/// 6".
/// \param jump   as found
/// \param nodes  what the stations are called, such as "nodes"
TENDRIL_CORE_API std::string describe(const FrameJump& jump, const std::string& nodes);

}  // namespace tendril
