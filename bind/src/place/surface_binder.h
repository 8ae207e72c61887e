#pragma once

#include <tendril/bind/binding.h>

#include "blend/branches.h"

namespace tendril::bind {

/// Binds any points of a mesh's surface as Binding binds the mesh's own: what that takes to know of the body
/// is found once.
class SurfaceBinder {
 public:
  /// Throws InvalidInput as Binding does.
  /// \param rest  kept by reference
  SurfaceBinder(std::span<const CurvePair> rest, const PolygonMesh& body, const BindOptions& options);

  /// \param points  on the surface of the body
  /// \param face    of the body, that each point is on; or none, where the points are the body's own
  Binding bind(Points points, std::span<const std::uint32_t> face) const;

 private:
  std::span<const CurvePair> rest_;
  BindOptions options_;
  double negligible_;  ///< w that is rounding [length]
  std::vector<CurveProjector> projectors_;
  std::unique_ptr<BodyBranches> branches_;  ///< none where the nearest point of one curve is all that counts
};

}  // namespace tendril::bind
