#pragma once

#include <tendril/bind/polygon_mesh.h>
#include <tendril/scene/contact.h>

namespace tendril::runner {

/// Adds the surface of a solid to a mesh of which all points have a color. A half space is a square about
/// the foot of `centre` on it.
/// \param pose    where the solid is
/// \param centre  of what is looked at
/// \param size    of what is looked at
void add_solid(const scene::SolidShape& shape, const scene::SolidPose& pose, const Vec3& centre, double size,
               bind::PolygonMesh& to);

/// The farthest points of a solid along its axes, for a camera; none of a half space.
std::vector<Vec3> reach_of(const scene::SolidShape& shape, const scene::SolidPose& pose);

}  // namespace tendril::runner
