#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>
#include <tendril/curve/frames.h>

#include <vector>

namespace tendril {

/// The two control polygons of a curve-pair, or its two chains of masses, of equal size. They are manipulated
/// together ([Chan 2008] section 2.2.3) so that the offset q_i - p_i = r_i (a_i m_i + b_i t_i) keeps r_i,
/// a_i, b_i.
struct PolygonPair {
  std::vector<Vec3> p;  ///< on the primary side
  std::vector<Vec3> q;  ///< on the orientation side
};

/// Moves p_i to `to`. The tangents at i - 1, i and i + 1 turn; each offset there follows its tangent by the
/// smallest rotation ([Chan 2008] 2.8, 2.9 with the rotation that 2.9 leaves open), so nothing twists. O(1).
/// Throws InvalidInput when i is out of range or `to` is not finite; the pair is then unchanged.
/// \return  ok, or the first degenerate tangent among the three (its offset is then only translated)
TENDRIL_CORE_API FrameStatus move_point(PolygonPair& pair, std::size_t i, const Vec3& to);

/// Turns the offset at i by `angle` [rad] about the polygon tangent there (right-hand rule). O(1). Throws
/// InvalidInput when i is out of range or the angle is not finite.
/// \return  ok, or why the tangent at i is degenerate (the rule of frames.h then names the axis)
TENDRIL_CORE_API FrameStatus twist_point(PolygonPair& pair, std::size_t i, double angle);

}  // namespace tendril
