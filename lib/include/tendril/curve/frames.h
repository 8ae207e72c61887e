#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <vector>

namespace tendril {

/// Orthonormal and right-handed: x cross y = z. For a curve frame (l_x, l_y, l_z) of [Chan 2008] 2.4, for a
/// node frame (l, m, t) of [Chan 2008] 2.7.
struct Frame {
  Vec3 x = Vec3::UnitX();  ///< l_x or l: y cross z
  Vec3 y = Vec3::UnitY();  ///< l_y or m: the side the orientation curve lies on
  Vec3 z = Vec3::UnitZ();  ///< l_z or t: the tangent
};

/// What became of a frame whose definition may fail. Anything but `ok` still comes with an orthonormal frame,
/// chosen by the rule named here, so that nothing downstream sees NaN.
enum class FrameStatus {
  ok,
  zero_speed,   ///< c' = 0: the tangent is that of the first derivative that does not vanish
  zero_edge,    ///< a polygon edge of length 0: the other edge's direction, else the node's before it
  fold_back,    ///< the two edges at a node are opposite: the incoming edge's direction
  zero_offset,  ///< the orientation point lies on the primary one: y towards the least aligned world axis
  offset_along_tangent,  ///< the offset is parallel to the tangent: y as for zero_offset
};

/// What frame_towards finds.
struct FrameChoice {
  Frame frame;                           ///< orthonormal whatever the status
  FrameStatus status = FrameStatus::ok;  ///< ok, zero_offset or offset_along_tangent
  double sine = 1.0;                     ///< of the angle between offset and tangent: how far from degenerate
};

/// Frame with the tangent z and y towards `offset` ([Chan 2008] 2.4, normalised): x = unit(offset cross z),
/// y = z cross x. Degenerate when |offset| = 0, or when the sine of the angle between the two is at most
/// 1e-12.
/// \param z       unit tangent
/// \param offset  of any length, finite
TENDRIL_CORE_API FrameChoice frame_towards(const Vec3& z, const Vec3& offset);

/// The smallest rotation that takes the unit vector `from` to the unit vector `to`, applied to v:
/// v - (a + b) ((a + b).v) / (1 + a.b) + 2 b (a.v). At to = -from, where none is smallest, a half turn about
/// the axis perpendicular to `from` and to the world axis least aligned with it.
TENDRIL_CORE_API Vec3 rotate_smallest(const Vec3& from, const Vec3& to, const Vec3& v);

/// v turned by `angle` about the unit axis (right-hand rule).
TENDRIL_CORE_API Vec3 rotate_about(const Vec3& axis, double angle, const Vec3& v);

/// What polygon_tangents finds, an entry per node.
struct PolygonTangents {
  std::vector<Vec3> t;              ///< unit
  std::vector<FrameStatus> status;  ///< ok, zero_edge or fold_back
};

/// Unit tangents of a chain of points ([Chan 2008] 2.7, normalised): inside, the unit sum of the two unit
/// edges, which bisects them; at either end, the edge. O(n).
/// \param p  at least 2; else InvalidInput
TENDRIL_CORE_API PolygonTangents polygon_tangents(Points p);

/// Frames along a chain or a curve, an entry per node.
struct NodeFrames {
  std::vector<Frame> frame;         ///< orthonormal whatever the status
  std::vector<FrameStatus> status;  ///< that of the node's tangent, or where that is ok, of its offset
};

/// Frames (l, m, t) at the masses p of a chain, m towards the orientation masses q ([Chan 2008] 2.7). O(n).
/// \param p  at least 2; else InvalidInput
/// \param q  as many; else InvalidInput
TENDRIL_CORE_API NodeFrames node_frames(Points p, Points q);

}  // namespace tendril
