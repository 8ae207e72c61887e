#pragma once

#include <tendril/dynamics/anchor.h>
#include <tendril/dynamics/force.h>
#include <tendril/dynamics/joint.h>
#include <tendril/dynamics/rod.h>

#include <memory>
#include <vector>

namespace tendril {

/// What a scene is made of, as the user says it.
struct Scene {
  std::vector<Rod> rods;
  std::vector<Anchor> anchors;
  std::vector<Joint> joints;
  std::vector<std::shared_ptr<const Force>> forces;
  /// Whether the twist angle and spin of each node are states. Left out, each rod keeps the directors that
  /// are carried along it without twist, and bends by the angle alone.
  enum class Twist { where_needed, everywhere } twist = Twist::where_needed;
};

}  // namespace tendril
