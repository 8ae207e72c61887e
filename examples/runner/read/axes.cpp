#include "read/axes.h"

#include <tendril/curve/frame_jump.h>
#include <tendril/scene/scene_error.h>

namespace tendril::runner {
namespace {

/// What a mesh is bound to has frames that carry on along it: else a vertex would jump.
void require_frames(const scene::CurveFile& curve) {
  const auto jump =
      curve.through ? find_frame_jump(curve.pair, curve.through->parameters()) : find_frame_jump(curve.pair);
  if (jump)
    throw InvalidInput(curve.place, describe(*jump, curve.through ? "nodes" : "knots"),
                       "orientation points beside the curve, less than 90 degrees from each to the next");
}

}  // namespace

Axes read_axes(const std::vector<std::string>& rest, const std::vector<std::string>& posed,
               const std::string& expected_knots) {
  if (!posed.empty() && posed.size() != rest.size())
    throw InvalidInput("--pose", std::to_string(posed.size()) + " files",
                       std::to_string(rest.size()) + ", one for each --axis");
  Axes axes;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const std::vector<scene::CurveFile> at_rest = scene::read_curves(rest[i]);
    for (const scene::CurveFile& curve : at_rest) {
      require_frames(curve);
      axes.rest.push_back(curve.pair);
      axes.names.push_back(curve.name.empty() ? curve.place : curve.name);
    }
    if (posed.empty()) continue;
    const std::vector<scene::CurveFile> in_pose = scene::read_curves(posed[i], at_rest);
    for (std::size_t k = 0; k < in_pose.size(); ++k) {
      if (!expected_knots.empty() && !(in_pose[k].pair.knots() == at_rest[k].pair.knots()))
        throw InvalidInput(in_pose[k].place, "its knots or degree differ from those of " + rest[i],
                           expected_knots);
      require_frames(in_pose[k]);
      axes.posed.push_back(in_pose[k].pair);
    }
  }
  return axes;
}

}  // namespace tendril::runner
