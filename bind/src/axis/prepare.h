#pragma once

#include <tendril/axis/axis_options.h>
#include <tendril/axis/axis_tree.h>
#include <tendril/bind/polygon_mesh.h>

namespace tendril::axis {

/// The map from the copy, of about unit size about the origin, back to the mesh: p = centre + scale q.
struct UnitScaling {
  Vec3 centre = Vec3::Zero();
  double scale = 1.0;  ///< the diagonal of its box

  Vec3 back(const Vec3& q) const { return centre + scale * q; }
};

struct Prepared {
  bind::PolygonMesh mesh;
  UnitScaling scaling;
};

/// A copy that CGAL can be given: one closed, manifold, oriented surface of triangles with some area, of at
/// least `least_points` points. Closed and cut down as the options say, else InvalidInput with all that is
/// wrong.
Prepared prepare(const bind::PolygonMesh& mesh, const AxisOptions& options, AxisReport& report);

}  // namespace tendril::axis
