#pragma once

#include <tendril/base/types.h>

#include <string>
#include <vector>

namespace tendril::runner {

/// Points from a text file: x,y,z on each line; blank lines and what follows a # are skipped, and the first
/// line may name the columns. InvalidInput as "name:line" for anything else, and for a file without points.
std::vector<Vec3> read_points_csv(const std::string& path);

}  // namespace tendril::runner
