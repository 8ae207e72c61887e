#pragma once

#include <tendril/scene/view.h>

#include <array>
#include <optional>
#include <string>

namespace tendril::runner {

/// A pinhole camera. A pixel's ray goes from `eye` along forward + x tan_x right + y tan_y up, x and y from
/// -1 to 1.
struct Camera {
  Vec3 eye, right, up, forward;
  double tan_x, tan_y;
  Vec3 ground_up;  ///< normal of the ground
  double ground;   ///< its height along the normal
  Vec3 centre;     ///< of what is looked at
  double size;     ///< diagonal of its bounding box, positive

  /// Where a point is seen: from -1 to 1 across the picture to the right and up. Nothing behind the eye.
  std::optional<std::array<double, 2>> place(const Vec3& p) const;
};

/// The direction that x, y, z, -x, -y or -z names; InvalidInput naming --up.
Vec3 up_direction(const std::string& name);

/// Gathers all that a sequence of pictures is to show, and places one camera for them all: as near as the
/// view's direction allows with a margin on every side. The ground goes under the lowest point.
class CameraFit {
 public:
  explicit CameraFit(const scene::ViewOptions& view);
  void include(Points points);
  Camera camera() const;

 private:
  Vec3 right_, up_, forward_, ground_up_;
  double tan_x_, tan_y_;
  /// Largest of +-x / tan_x - z and +-y / tan_y - z over the points, coordinates in the camera's axes: how
  /// far back each side of the picture asks the eye to be.
  std::array<double, 4> reach_;
  Vec3 low_, high_;
  double ground_;
};

}  // namespace tendril::runner
