#pragma once

#include <tendril/base/export.h>
#include <tendril/scene/scene_run.h>

#include <string>

namespace tendril::scene {

/// The masses of a run as a table, a line for each output, curve-pair and node: the time, both numbers, the
/// mass and its orientation mass, in the scene's units. Numbers are the shortest that read back to the same
/// double, whatever the locale; lines end with "\n".
class TENDRIL_SCENE_API Trajectory {
 public:
  /// Appends the lines of a moment.
  void add(const Snapshot& snapshot);
  /// The lines so far below the header "time,rod,node,px,py,pz,qx,qy,qz".
  const std::string& csv() const { return csv_; }

 private:
  std::string csv_ = "time,rod,node,px,py,pz,qx,qy,qz\n";
};

}  // namespace tendril::scene
