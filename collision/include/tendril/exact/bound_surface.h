#pragma once

#include <tendril/collision/axial_hierarchy.h>
#include <tendril/exact/surface.h>

namespace tendril::exact {

/// The surface of a mesh that follows curve-pairs, asked as a Surface is, with the answers that one of the
/// whole mesh updated would give; what a query does not come near is not deformed
/// (collision::AxialHierarchy). Queries change what is kept: one thread at a time.
class TENDRIL_EXACT_API BoundSurface {
 public:
  /// In its rest pose. Throws InvalidInput as AxialHierarchy does, and as pose() does for the rest.
  /// \param rest       the curve-pairs in their rest shapes
  /// \param points     bound to them; not kept
  /// \param triangles  of indices into the points; degenerate ones are what is left of them
  /// \param options    of the hierarchy
  BoundSurface(std::span<const CurvePair> rest, const BoundPoints& points,
               std::span<const collision::Triangle> triangles,
               const collision::HierarchyOptions& options = {});

  /// What follows is about this pose. Throws InvalidInput for control points beyond 2^200, whose frames could
  /// overflow, and as AxialHierarchy::pose does.
  void pose(std::span<const CurvePair> posed);
  /// What queries have cost since the last pose.
  collision::HierarchyWork work() const { return hierarchy_.work(); }

  /// The number of triangles.
  std::size_t size() const { return hierarchy_.size(); }
  /// In every pose: every edge belongs to an even number of triangles, where points bound alike are one.
  bool closed() const { return closure_ != Closure::open; }

  /// As Surface::relation.
  Answer relation(const Shape& shape);
  /// As Surface::meetings.
  std::vector<Meeting> meetings(const Shape& shape);
  /// As Surface::meetings with a surface in its place.
  std::vector<Meeting> meetings(const Surface& other);
  /// As Surface::inside; the winding number of an open surface deforms all of it.
  Inside inside(const Vec3& point);
  /// As Surface::solid_relation.
  Answer solid_relation(const Vec3& centre, double radius);
  /// As Surface::nearest.
  Nearest nearest(const Shape& shape);

 private:
  double winding_about(const Vec3& point);

  collision::AxialHierarchy hierarchy_;
  Closure closure_;
};

}  // namespace tendril::exact
