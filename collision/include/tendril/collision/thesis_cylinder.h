#pragma once

#include <tendril/base/export.h>
#include <tendril/curve/axial.h>

#include <span>
#include <vector>

namespace tendril::collision {

/// The bounding cylinder of [Chan 2008] section 3.7, as it is written there: a comparator, no bounding
/// volume. The curve's domain is cut into equal regions, one fewer than it has control points. In each the
/// vertex farthest from the curve, r = sqrt(u^2 + v^2), is a knot (t, r); the ends of the curve are knots of
/// radius 0; between knots r is linear (3.39). An empty region has the radius of the one before it (0 before
/// the first), here at the region's middle, which the source leaves open.
///
/// It errs both ways. Not held: vertices above the chord between two knots, all that lies beyond or near the
/// two ends, the knots themselves (a point is inside where r is *smaller*), and whatever of a triangle is
/// outside while its corners are not. Held: the air beside flat or bent cross-sections. AxialSections and
/// AxialHierarchy replace it.
class TENDRIL_COLLISION_API ThesisCylinder {
 public:
  /// \param vertices  records of the mesh's vertices on one curve-pair
  /// \param knots     of that curve-pair
  ThesisCylinder(std::span<const AxialPoint> vertices, const KnotVector& knots);

  /// (3.39) at t in the domain.
  double radius(double t) const;
  /// start < t < end and r < radius(t), both strict.
  bool holds(const AxialPoint& e) const;

 private:
  std::vector<double> t_, r_;
};

}  // namespace tendril::collision
