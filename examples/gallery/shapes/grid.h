#pragma once

#include <tendril/bind/polygon_mesh.h>

namespace tendril::gallery {

/// A sheet of columns x rows points, row after row: x across its middle, z down from 0; faces are quads.
bind::PolygonMesh hanging_sheet(int columns, int rows, double width, double height);

/// Points along the middle of such a sheet, from its upper edge down.
std::vector<Vec3> middle_of_sheet(int rows, double height);

}  // namespace tendril::gallery
