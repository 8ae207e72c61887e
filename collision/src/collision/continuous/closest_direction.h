#pragma once

#include "time_interval.h"

/// Directions in which two features are likely to be apart: from the closest point of one to that of the
/// other. Any vector would do for the proof, so nothing here needs to be accurate; degenerate features may
/// give zero or NaN, along which nothing is ever found apart. After
/// [Ericson 2005] 5.1.5 and 5.1.9.
namespace tendril::collision {

/// From the vertex to the closest point of the face.
Vec3 vertex_face_direction(const Instant& at);

/// From the closest point of the first edge to that of the second.
Vec3 edge_edge_direction(const Instant& at);

}  // namespace tendril::collision
