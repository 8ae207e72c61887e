#pragma once

#include <tendril/bind/import.h>

namespace tendril::runner {

/// Reads a mesh; what is odd about the file but not refused goes to standard error.
bind::PolygonMesh read_mesh(const std::string& path);

}  // namespace tendril::runner
