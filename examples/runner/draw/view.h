#pragma once

#include <tendril/base/types.h>

namespace tendril::runner {

/// From where and how finely a picture is taken.
struct ViewOptions {
  Vec3 up = Vec3::UnitY();
  double yaw = 35.0;    ///< degrees about `up`, from the view along the world axis least aligned with it
  double pitch = 12.0;  ///< degrees above the horizon, -89 to 89
  int width = 960, height = 720;
  int samples = 12;  ///< per pixel
};

}  // namespace tendril::runner
