#pragma once

#include <tendril/base/types.h>

namespace tendril::scene {

/// From where and how finely a picture is to be taken. The library draws none: this is what a scene says
/// under `picture`, and what the program `tendril` draws by.
struct ViewOptions {
  Vec3 up = Vec3::UnitY();  ///< unit vector
  double yaw = 35.0;        ///< degrees about `up`, from the view along the world axis least aligned with it
  double pitch = 12.0;      ///< degrees above the horizon, -89 to 89
  int width = 960;          ///< pixels, 16 to 8192
  int height = 720;         ///< the same
  int samples = 12;         ///< per pixel, 1 to 1024
};

}  // namespace tendril::scene
