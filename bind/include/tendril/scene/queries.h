#pragma once

#include <tendril/base/export.h>
#include <tendril/base/types.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tendril::scene {

/// A solid sphere.
struct QueryBall {
  Vec3 centre;    ///< finite
  double radius;  ///< positive
};

/// What is held against a mesh, in the mesh's units and frame, each list in the file's order. All numbers are
/// finite; segments without length and triangles without area are what is left of them.
struct Queries {
  std::vector<Vec3> points;                    ///< "points": [[x, y, z], ...]
  std::vector<QueryBall> balls;                ///< "balls": [{"centre": [x, y, z], "radius": r}, ...]
  std::vector<std::array<Vec3, 2>> segments;   ///< "segments": [[from, to], ...]
  std::vector<std::array<Vec3, 3>> triangles;  ///< "triangles": [[a, b, c], ...]
};

/// Reads a file of queries: JSON with comments, held against queries.schema.json.
///
/// Throws SceneError for what the file says (no query at all included), FileError when it cannot be read.
/// O(file).
TENDRIL_SCENE_API Queries read_queries(const std::string& path);

/// The same of a text in memory.
/// \param text  what the file would hold
/// \param name  stands for the file in messages
TENDRIL_SCENE_API Queries parse_queries(std::string_view text, const std::string& name);

}  // namespace tendril::scene
