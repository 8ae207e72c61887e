#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/curve_pair.h>

#include <span>

namespace tendril {

/// A consumer of steps: what turns the moving curve-pairs into a mesh, a file, a collision query. Called once
/// per accepted step or once per output time, never on a step that is rejected later.
class TENDRIL_CORE_API Follower {
 public:
  virtual ~Follower() = default;

  /// \param time   of the state
  /// \param pairs  the curve-pairs through the point masses at that time, one per rod, valid during the call
  virtual void follow(double time, std::span<const CurvePair> pairs) = 0;
};

}  // namespace tendril
