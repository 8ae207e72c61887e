#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/hierarchy_options.h>
#include <tendril/curve/axial.h>

#include <span>
#include <vector>

namespace tendril::collision {

/// The shape that bounds a region across the curve, in the (u, v) plane of its frame.
enum class Section {
  circle,  ///< about the curve: with it the regions make a cylinder of steps
  box,     ///< u and v
  octagon  ///< u, v, u + v and u - v: an 8-dop
};

/// A bounding volume of a mesh along one curve-pair, made once from its records: the curve's domain is cut
/// into equal regions, each with a section about all triangles that reach into it; and one beyond
/// either end of the curve with the range of w there.
///
/// Conservative: it holds the record of every vertex, so every vertex in every pose; and where the curve-pair
/// is straight and not turned every point of the triangles. In a bent pose the tube curves and triangles do
/// not, so that some of the surface lies outside (up to a few percent of it), and past a focal radius a
/// point's nearest place is not that of its record. AxialHierarchy has neither fault.
class TENDRIL_COLLISION_API AxialSections {
 public:
  /// \param records    of the points on one curve-pair
  /// \param triangles  of indices into them; else InvalidInput
  /// \param knots      of the curve-pair
  /// \param section    the shape across the curve
  /// \param regions    1 or more, else InvalidInput
  /// \param allowance  added to every reach, in units of the largest |u|, |v| or |w|, and to a region's ends,
  /// in units of the domain: what the rounding of a projection needs. 0 or more, else InvalidInput
  AxialSections(std::span<const AxialPoint> records, std::span<const Triangle> triangles,
                const KnotVector& knots, Section section, std::size_t regions, double allowance = 1e-9);

  /// Whether the record of a point, usually of its nearest point on the posed curve, is in the volume. O(1).
  bool holds(const AxialPoint& e) const;

 private:
  /// How far the region goes in each of eight directions, or about the curve.
  struct Region {
    std::array<double, 8> reach;
    double radius = -1.0, deepest = 0.0;
  };
  static Region empty();
  static void take_in(double u, double v, Region& region);
  void add(const AxialPoint& a, const AxialPoint& b, const AxialPoint& c, double over);
  bool holds(const Region& region, double u, double v) const;
  std::size_t region_of(double t) const;

  Section section_;
  double start_, length_;
  std::vector<Region> regions_;
  Region before_, after_;
};

}  // namespace tendril::collision
