#pragma once

#include <tendril/base/export.h>
#include <tendril/scene/scene_run.h>

#include <string>

namespace tendril::scene {

/// What the anchors of a scene do to its rods as a table, a line for each output and anchor: the time, the
/// anchor's number among all of the scene's, those of its curve-pair and node, the force on the node and the
/// torque about it (Support), in the scene's units and the world's axes. Numbers are the shortest that read
/// back to the same double, whatever the locale; lines end with "\n".
class TENDRIL_SCENE_API SupportTable {
 public:
  /// Appends the lines of a moment; none where the scene asks for no supports.
  /// \param file      the scene
  /// \param snapshot  of its run
  void add(const SceneFile& file, const Snapshot& snapshot);
  /// The lines so far below the header "time,anchor,rod,node,fx,fy,fz,tx,ty,tz".
  const std::string& csv() const { return csv_; }

 private:
  std::string csv_ = "time,anchor,rod,node,fx,fy,fz,tx,ty,tz\n";
};

}  // namespace tendril::scene
