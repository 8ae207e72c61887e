#pragma once

#include <tendril/dynamics/scene.h>

#include <vector>

namespace tendril {

/// Where a step shall end, and whether a force jumps there.
struct Aim {
  double h, time;
  bool at_break;

  /// The step as its stages may see it: before a jump they must not see what comes after it, so that it ends
  /// just before.
  double seen(double now) const;
};

/// A way to go without a jump in between.
struct Stretch {
  double end;
  bool at_break;  ///< a force jumps at its end
};

/// The times at which forces jump, or the motion of anchors.
class Breaks {
 public:
  explicit Breaks(const Scene& scene);

  /// From now to the target, or to the next jump where that comes first.
  Stretch from(double now, double target) const;

 private:
  std::vector<double> times_;  ///< ascending
};

/// The shortest period of what forces and anchors do of themselves; infinite where nothing repeats.
double shortest_period(const Scene& scene);

}  // namespace tendril
