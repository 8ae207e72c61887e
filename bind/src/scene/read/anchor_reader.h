#pragma once

#include "scene/json/json_node.h"

#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/rod.h>

namespace tendril::scene {

/// How something moves.
struct ReadMotion {
  std::function<AnchorPose(double)> pose;  ///< empty for what stands still
  double period = Anchor{}.period;         ///< the shortest
};

/// The motion that `translation` and `rotation` of a node of the file say, or nothing where it has neither.
/// \param rest   the place that moves, and about which it turns unless the file says otherwise
/// \param frame  that turns
ReadMotion read_motion(const JsonNode& node, const Vec3& rest, const Frame& frame);

/// One entry of a curve-pair's anchors: an anchor for each node it names.
std::vector<Anchor> read_anchors(const JsonNode& anchor, std::size_t rod_index, const Rod& rod);

}  // namespace tendril::scene
