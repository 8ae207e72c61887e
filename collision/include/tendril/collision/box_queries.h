#pragma once

#include <tendril/base/export.h>
#include <tendril/collision/box_tree.h>

/// What a box is asked by queries that are no boxes. Nothing that meets is lost to rounding.
namespace tendril::collision {

/// Square of the distance from a box, rounded: relative error at most 2^-50.
TENDRIL_COLLISION_API double square_distance(const Box& box, const Vec3& point);
/// True when the closed segment meets the box; may be true by a rounding when they are closer than 2^-48 of
/// the largest coordinate.
TENDRIL_COLLISION_API bool segment_meets(const Box& box, const Vec3& a, const Vec3& b);

}  // namespace tendril::collision
