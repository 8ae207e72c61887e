#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <vector>

namespace tendril {

/// Orthonormal and right-handed: x cross y = z. For a curve frame (l_x, l_y, l_z) of thesis 2.4, for a node
/// frame (l, m, t) of thesis 2.7; z is the tangent, y the side the orientation curve lies on.
struct Frame {
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();
};

/// What became of a frame whose definition may fail. Anything but `ok` still comes with an orthonormal frame,
/// chosen by the rule named here, so that nothing downstream sees NaN.
enum class FrameStatus {
  ok,
  zero_speed,   ///< c' = 0: the tangent is that of the first derivative that does not vanish
  zero_edge,    ///< a polygon edge of length 0: the other edge's direction, else the node's before it
  fold_back,    ///< the two edges at a node are opposite: the incoming edge's direction
  zero_offset,  ///< the orientation point lies on the primary one: y towards the least aligned world axis
  offset_along_tangent,  ///< the offset is parallel to the tangent: as above
};

/// Frame with the tangent z and y towards `offset` (thesis 2.4, normalised: x = unit(offset cross z), y = z
/// cross x). \param z  unit tangent Degenerate when |offset| = 0, or when the sine of the angle between the
/// two is below 1e-12.
struct FrameChoice {
  Frame frame;
  FrameStatus status = FrameStatus::ok;
  double sine = 1.0;  ///< of the angle between offset and tangent: how far from degenerate
};
TENDRIL_CORE_API FrameChoice frame_towards(const Vec3& z, const Vec3& offset);

/// The smallest rotation that takes the unit vector `from` to the unit vector `to`, applied to v:
/// v - (a + b) ((a + b).v) / (1 + a.b) + 2 b (a.v). At to = -from, where none is smallest, a half turn about
/// the axis perpendicular to `from` and to the world axis least aligned with it.
TENDRIL_CORE_API Vec3 rotate_smallest(const Vec3& from, const Vec3& to, const Vec3& v);

/// v turned by `angle` about the unit axis (right-hand rule).
TENDRIL_CORE_API Vec3 rotate_about(const Vec3& axis, double angle, const Vec3& v);

/// Unit polygon tangents of a chain (thesis 2.7, normalised): the bisector of the two unit edges inside, the
/// edge at the two ends. `status` has an entry per node.
struct PolygonTangents {
  std::vector<Vec3> t;
  std::vector<FrameStatus> status;
};
TENDRIL_CORE_API PolygonTangents polygon_tangents(Points p);

/// Node frames of a chain of masses p with the orientation masses q. Sizes equal, at least 2; else
/// InvalidInput. The status of a node is that of its tangent, or else that of its offset.
struct NodeFrames {
  std::vector<Frame> frame;
  std::vector<FrameStatus> status;
};
TENDRIL_CORE_API NodeFrames node_frames(Points p, Points q);

}  // namespace tendril
